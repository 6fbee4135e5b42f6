// Two blocks that meet in x = 1 without sharing vertices, the right one finer. gmsh -2 -format msh41|msh22 [-bin]
Point(1) = {0, 0, 0, 0.5}; Point(2) = {1, 0, 0, 0.5}; Point(3) = {1, 1, 0, 0.5}; Point(4) = {0, 1, 0, 0.5};
Point(5) = {1, 0, 0, 0.34}; Point(6) = {2, 0, 0, 0.34}; Point(7) = {2, 1, 0, 0.34}; Point(8) = {1, 1, 0, 0.34};
For i In {0:3}
  Line(1 + i) = {1 + i, 1 + (i + 1) % 4};
  Line(5 + i) = {5 + i, 5 + (i + 1) % 4};
EndFor
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Curve Loop(2) = {5:8}; Plane Surface(2) = {2};
Physical Surface("left") = {1};
Physical Surface("right") = {2};
Physical Curve("left_bottom") = {1};
Physical Curve("left_face") = {2};
Physical Curve("load") = {4};
Physical Curve("wall") = {6};
Physical Curve("right face") = {8};
Physical Curve(77) = {3};
Geometry.AutoCoherence = 0;
