// Visibility past one more object's field of distances (evaluation/methods/object_cones.py), by a cone or,
// of a point, by a ray. Objects are assumed to occlude independently.
uniform usampler2D before; // visibility past the others
uniform bool begins;       // there are no others
uniform vec3 centre;       // of the light, metres
uniform float radius;
uniform float sceneSize;
uniform float lift;        // of the cone's start from the surface, metres
uniform mat4 backwards;    // to the object's place at rest
uniform vec3 middle;       // of the field's sphere there
uniform float reach;       // its radius, metres
layout(location = 0) out uvec4 answer;

void main() {
  Receiver r;
  ivec2 at = ivec2(gl_FragCoord.xy);
  answer = bitsOf(vec4(1.0));
  if (!receive(at, centre, r)) return;
  vec3 start = r.p + lift * r.face, towards = centre - start;
  float away = length(towards), slope = max(radius, 1e-5 * sceneSize) / away;
  vec3 d = towards / away;
  // What is below the receiver's own plane does not count again.
  float above = halfDisc(dot(r.face, d) / slope), visible = begins ? above : floatsAt(before, at).x;
  if (visible > 0.0 && above > 0.0) {
    vec3 from = ((backwards * vec4(start, 1.0)).xyz - middle) / reach;
    mat3 turn = mat3(backwards);
    visible *= min(coneVisibility(from, turn * r.face, turn * d, slope, away / reach) / above, 1.0);
  }
  answer = bitsOf(vec4(visible));
}
