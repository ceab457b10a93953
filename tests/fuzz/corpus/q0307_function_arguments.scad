a = sqrt();
b = sin(1, 2);
c = cross([1, 2], [3, 4, 5]);
d = max([]);
e = len(4);
