// Right half of a pin in the hole of a large plate, both of radius 1 and in the same facets of 1.5 degrees where they may
// touch, up to 90 degrees from the lowest point. The core of the pin carries the load; the plate ends at radius 20.
core = 0.1; far = 20; facets = 60; turn = Pi / 2 / facets;
Geometry.AutoCoherence = 0;
Point(1) = {0, 0, 0};
// Pin: points 100 to 160, arcs 100 to 159; hole: points 200 to 260, arcs 200 to 259.
For side In {1:2}
  For i In {0:facets}
    Point(100 * side + i) = {Sin(i * turn), -Cos(i * turn), 0};
  EndFor
  For i In {0:facets - 1}
    Circle(100 * side + i) = {100 * side + i, 1, 100 * side + i + 1};
    Transfinite Curve {100 * side + i} = 2;
  EndFor
EndFor
Point(4) = {0, 1, 0}; Point(5) = {0, -core, 0}; Point(6) = {core, -core, 0}; Point(7) = {core, core, 0}; Point(8) = {0, core, 0};
Circle(2) = {160, 1, 4}; Line(3) = {4, 8}; Line(4) = {8, 7}; Line(5) = {7, 6}; Line(6) = {6, 5}; Line(7) = {5, 100}; Line(8) = {8, 5};
Curve Loop(1) = {100:159, 2:7}; Plane Surface(1) = {1};
Curve Loop(2) = {4, 5, 6, -8}; Plane Surface(2) = {2};
Point(14) = {0, 1, 0}; Point(15) = {0, -far, 0}; Point(16) = {far, 0, 0}; Point(17) = {0, far, 0};
Circle(12) = {260, 1, 14}; Line(13) = {14, 17}; Circle(14) = {17, 1, 16}; Circle(15) = {16, 1, 15}; Line(16) = {15, 200};
Curve Loop(3) = {200:259, 12:16}; Plane Surface(3) = {3};
Physical Surface("pin") = {1};
Physical Surface("core") = {2};
Physical Surface("plate") = {3};
Physical Curve("round") = {100:159};
Physical Curve("hole") = {200:259};
Physical Curve("rim") = {14, 15};
Physical Curve("axis") = {3, 7, 8, 13, 16};
Field[1] = Distance; Field[1].CurvesList = {100:159}; Field[1].Sampling = 3;
Field[2] = MathEval; Field[2].F = Sprintf("%g + 0.15 * F1", turn);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
