// Right halves of two elastic cylinders of radius 50 and 30, cut at their centres, one upon the other. Each arc has edges
// of its own, about 20 across the half-width of contact, 0.95.
radius = 50; second = 30; reach = 1.6;
arc = 0.05; line = 0.043;
angle = Asin(reach / radius); other = Asin(reach / second);
Point(1) = {0, 0, 0}; Point(2) = {radius * Sin(angle), radius * (1 - Cos(angle)), 0}; Point(3) = {radius, radius, 0};
Point(4) = {0, radius, 0};
Circle(1) = {1, 4, 2}; Circle(2) = {2, 4, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {0, 0, 0}; Point(12) = {second * Sin(other), -second * (1 - Cos(other)), 0}; Point(13) = {second, -second, 0};
Point(14) = {0, -second, 0};
Circle(11) = {12, 14, 11}; Circle(12) = {13, 14, 12}; Line(13) = {14, 13}; Line(14) = {11, 14};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve {1} = Round(radius * angle / arc) + 1;
Transfinite Curve {11} = Round(second * other / line) + 1;
Physical Surface("upper") = {1};
Physical Surface("lower") = {2};
Physical Curve("upper_round") = {1};
Physical Curve("lower_round") = {11};
Physical Curve("top") = {3};
Physical Curve("ground") = {13};
Physical Curve("axis") = {4, 14};
Field[1] = Distance; Field[1].CurvesList = {1, 11}; Field[1].Sampling = 200;
Field[2] = MathEval; Field[2].F = Sprintf("%g + 0.15 * F1", arc);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
Geometry.AutoCoherence = 0;
