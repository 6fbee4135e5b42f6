// A bracket with a rounded inner corner on a cushion with a finer mesh: their common side has different vertices.
Geometry.AutoCoherence = 0;
Point(1) = {0, 1, 0, 0.15}; Point(2) = {2, 1, 0, 0.15}; Point(3) = {2, 1.5, 0, 0.15}; Point(4) = {1.2, 1.5, 0, 0.08};
Point(5) = {0.7, 2, 0, 0.08}; Point(6) = {0.7, 3, 0, 0.15}; Point(7) = {0, 3, 0, 0.15}; Point(8) = {1.2, 2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Circle(4) = {4, 8, 5}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 1};
Curve Loop(1) = {1:7}; Plane Surface(1) = {1};
Point(11) = {0, 0, 0, 0.2}; Point(12) = {2, 0, 0, 0.2}; Point(13) = {2, 1, 0, 0.11}; Point(14) = {0, 1, 0, 0.11};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Physical Surface("bracket") = {1};
Physical Surface("cushion") = {2};
Physical Curve("foot") = {1};
Physical Curve("load") = {6};
Physical Curve("guide") = {7};
Physical Curve("ground") = {11};
Physical Curve("seat") = {13};
