// Nothing: what triangles cost a device before anybody looks at a fragment.
void main() {}
