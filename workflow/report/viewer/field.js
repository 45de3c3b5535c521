// Occupancy fields as methods: rays through one, and cones where its values are distances.

function fieldMethod(data) {
  const constants = { SOLID, ROW_BRICKS, SAMPLES_PER_CELL: `${data.samples_per_cell}.0` };
  let textures = null;
  const texturesOf = (gl) => textures ??= fieldTextures(gl, data);
  const cones = {
    ...data, key: `${data.key}_cones`, constants, sources: ["field_values", "cones", "sun_cones"],
    underSun: "one walk to the sun, split into 8 where it is partly covered",
    make({ gl }) {
      const uniforms = { ...texturesOf(gl), ...coneUniforms(gl, data) };
      return () => uniforms;
    },
  };
  return {
    ...data, constants, sources: ["sun_rays", "unit_sphere", "field_values", "field"], rays: true, ofShipped: true,
    soft: data.arrays.around && cones,
    make({ gl }) {
      const values = { level: data.level, depthBias: data.depth_bias, sheet: data.surface === "sheet" };
      return () => ({ ...texturesOf(gl), ...values });
    },
  };
}
