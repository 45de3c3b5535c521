// Arrays as viewer/packed.py writes them: their bytes in planes, deflated, in base64.

const KINDS = {
  uint8: Uint8Array, int8: Int8Array, uint16: Uint16Array, uint32: Uint32Array, float32: Float32Array,
};

async function unpack({ kind, data }) {
  const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const size = KINDS[kind].BYTES_PER_ELEMENT, count = planes.length / size;
  const whole = new Uint8Array(planes.length);
  for (let plane = 0; plane < size; plane++) {
    for (let i = 0; i < count; i++) whole[i * size + plane] = planes[plane * count + i];
  }
  return new KINDS[kind](whole.buffer);
}

// An integer from its zigzag number.
const signed = (zigzag) => zigzag & 1 ? -(zigzag + 1) / 2 : zigzag / 2;
