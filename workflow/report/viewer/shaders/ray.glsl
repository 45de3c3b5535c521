// The reference: a shadow ray through the mesh's tree of boxes (bvh.js), in the order of its nodes,
// from each to its first child or, if it is missed or a leaf, to where its `skip` says.
uniform sampler2D nodes;     // (lowest corner, skip), (highest corner, leaf's triangles)
uniform sampler2D triangles; // three corners each; w of the first: unused
uniform int nodeCount;

vec4 at(sampler2D data, int i) {
  int width = textureSize(data, 0).x;
  return texelFetch(data, ivec2(i % width, i / width), 0);
}

bool meets(vec3 p, vec3 light, int triangle) {
  vec3 a = at(triangles, 3 * triangle).xyz;
  vec3 ab = at(triangles, 3 * triangle + 1).xyz - a, ac = at(triangles, 3 * triangle + 2).xyz - a;
  vec3 across = cross(light, ac);
  float volume = dot(ab, across);
  if (volume == 0.0) return false;
  vec3 from = p - a;
  float u = dot(from, across) / volume;
  vec3 other = cross(from, ab);
  float v = dot(light, other) / volume;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && dot(ac, other) / volume > 0.0;
}

bool lit(vec3 p, vec3 light) {
  vec3 inverse = 1.0 / mix(vec3(1e-20), light, greaterThan(abs(light), vec3(1e-20)));
  int node = 0;
  while (node < nodeCount) {
    vec4 low = at(nodes, 2 * node), high = at(nodes, 2 * node + 1);
    vec3 one = (low.xyz - p) * inverse, two = (high.xyz - p) * inverse;
    vec3 near = min(one, two), far = max(one, two);
    bool crossed = max(max(near.x, near.y), max(near.z, 0.0)) <= min(far.x, min(far.y, far.z));
    int leaf = int(high.w); // first triangle · 8 + how many; 0 for an inner node
    if (crossed)
      for (int k = 0; k < leaf % 8; k++)
        if (meets(p, light, leaf / 8 + k)) return false;
    node = crossed && leaf == 0 ? node + 1 : int(low.w);
  }
  return true;
}
