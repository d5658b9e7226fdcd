// An empty shader, to measure the cost of triangles without shading.
void main() {}
