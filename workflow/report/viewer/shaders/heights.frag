in float height;
layout(location = 0) out vec4 found;

void main() {
  found = vec4(height, 0.0, 0.0, 1.0);
}
