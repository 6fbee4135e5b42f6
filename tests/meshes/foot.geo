// Right half of a block, 120 wide and high, whose foot may touch up to 2: edges of 0.1 there, growing with the distance.
size = 0.1; foot = 2; width = 120;
Point(1) = {0, 0, 0}; Point(2) = {foot, 0, 0}; Point(3) = {width, 0, 0}; Point(4) = {width, width, 0}; Point(5) = {0, width, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Transfinite Curve {1} = Round(foot / size) + 1;
Curve Loop(1) = {1:5}; Plane Surface(1) = {1};
Physical Surface("block") = {1};
Physical Curve("foot") = {1};
Physical Curve("top") = {4};
Physical Curve("axis") = {5};
Field[1] = Distance; Field[1].CurvesList = {1}; Field[1].Sampling = 200;
Field[2] = MathEval; Field[2].F = Sprintf("%g + 0.2 * F1", size);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
