r = 4
cube(r)
