// Right halves of two blocks that meet on y = 0: edges of 0.05 where they may touch, growing with the distance.
size = 0.05; foot = 2; width = 30;
Geometry.AutoCoherence = 0;
For body In {0:1}
  p = 10 * body; up = width * (1 - 2 * body);
  Point(p + 1) = {0, 0, 0}; Point(p + 2) = {foot, 0, 0}; Point(p + 3) = {width, 0, 0};
  Point(p + 4) = {width, up, 0}; Point(p + 5) = {0, up, 0};
  For i In {1:5}
    Line(p + i) = {p + i, p + 1 + i % 5};
  EndFor
  Transfinite Curve {p + 1} = 41;
  Curve Loop(body + 1) = {p + 1:p + 5}; Plane Surface(body + 1) = {body + 1};
EndFor
Physical Surface("upper") = {1};
Physical Surface("lower") = {2};
Physical Curve("upper_face") = {1, 2};
Physical Curve("lower_face") = {11, 12};
Physical Curve("top") = {4};
Physical Curve("ground") = {14};
Physical Curve("upper_axis") = {5};
Physical Curve("lower_axis") = {15};
Field[1] = Distance; Field[1].EdgesList = {1}; Field[1].NNodesByEdge = 200;
Field[2] = MathEval; Field[2].F = Sprintf("%g + 0.15 * F1", size);
Background Field = 2;
Mesh.CharacteristicLengthExtendFromBoundary = 0; Mesh.CharacteristicLengthFromPoints = 0;
