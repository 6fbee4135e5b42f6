// Right half of a block under a flat rigid punch of half-width 1: edges grow with the distance from the punch, more
// slowly around its corner, where the stress is singular.
width = 20;
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {width, 0, 0}; Point(4) = {width, -width, 0}; Point(5) = {0, -width, 0};
For i In {1:5}
  Line(i) = {i, 1 + i % 5};
EndFor
Curve Loop(1) = {1:5}; Plane Surface(1) = {1};
Physical Surface("block") = {1};
Physical Curve("punch") = {1};
Physical Curve("base") = {4};
Physical Curve("axis") = {5};
Field[1] = Distance; Field[1].NodesList = {2};
Field[2] = MathEval; Field[2].F = "0.002 + 0.15 * F1";
Background Field = 2;
Mesh.CharacteristicLengthExtendFromBoundary = 0; Mesh.CharacteristicLengthFromPoints = 0;
