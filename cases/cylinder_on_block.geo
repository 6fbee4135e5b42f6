// Right half of an elastic cylinder of radius 50, cut at its centre, that lies on an elastic block. Both are meshed as
// they are, each with edges of its own: about 20 of the arc across the half-width of contact, 1.
radius = 50; width = 50; reach = 1.6;
arc = 0.05; line = 0.05;
angle = Asin(reach / radius);
Point(1) = {0, 0, 0}; Point(2) = {radius * Sin(angle), radius * (1 - Cos(angle)), 0}; Point(3) = {radius, radius, 0};
Point(4) = {0, radius, 0};
Circle(1) = {1, 4, 2}; Circle(2) = {2, 4, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {0, -width, 0}; Point(12) = {width, -width, 0}; Point(13) = {width, 0, 0}; Point(14) = {reach, 0, 0};
Point(15) = {0, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 11};
Curve Loop(2) = {11:15}; Plane Surface(2) = {2};
Transfinite Curve {1} = Round(radius * angle / arc) + 1;
Transfinite Curve {14} = Round(reach / line) + 1;
Physical Surface("cylinder") = {1};
Physical Surface("block") = {2};
Physical Curve("round") = {1};
Physical Curve("flat") = {14};
Physical Curve("top") = {3};
Physical Curve("ground") = {11};
Physical Curve("axis") = {4, 15};
Field[1] = Distance; Field[1].CurvesList = {1, 14}; Field[1].Sampling = 200;
Field[2] = MathEval; Field[2].F = Sprintf("%g + 0.15 * F1", arc);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
Geometry.AutoCoherence = 0;
