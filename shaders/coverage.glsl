// How much of a pixel a cut-out covers, for alpha to coverage.

// `margin` is alpha minus its threshold at the pixel's centre. The edge of the cut-out is where it is
// 0; alpha's own slope says nothing, so it is sharpened to one pixel across the edge: to first order
// the edge is a line at the signed distance margin / |gradient|, and a line at a distance of half a
// pixel leaves all of the pixel or nothing. (Exact for lines along rows and columns, off by 0.04
// at most for diagonal ones.)
float coverage_at(float margin) {
  float change = length(vec2(dFdx(margin), dFdy(margin)));
  // A constant has no edge: the threshold itself still exists, as in the alpha test.
  if (change == 0.0) return margin >= 0.0 ? 1.0 : 0.0;
  return clamp(margin / change + 0.5, 0.0, 1.0);
}
