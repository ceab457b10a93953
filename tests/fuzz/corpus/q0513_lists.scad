polyhedron(points = [[0, 0], [1, 0, 0]], faces = [[0, 1, 2]]);
polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1]]);
polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1, 4]]);
polyhedron(points = 3, faces = [[0, 1, 4]]);
