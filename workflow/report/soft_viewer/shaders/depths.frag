// Distance from the light to the triangle's plane through a texel's middle, in metres; not where the
// rasteriser has put it, see surface.frag.
flat in vec3 corner;
flat in vec3 faceN;
uniform mat3 axes;
uniform vec2 begin; // of the face's texels
uniform float side; // of the face, in texels
layout(location = 0) out uint depth;

void main() {
  vec3 way = axes * vec3(2.0 * (gl_FragCoord.xy - begin) / side - 1.0, 1.0);
  depth = bitsOf(dot(corner, faceN) / dot(way, faceN) * length(way));
}
