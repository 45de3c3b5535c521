in float height;
layout(location = 0) out uint found;

void main() {
  found = bitsOf(height);
}
