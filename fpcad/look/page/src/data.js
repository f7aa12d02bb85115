// The run's document and the block of numbers that it refers to.

const TYPES = { f4: Float32Array, i2: Int16Array, i4: Int32Array, u1: Uint8Array };
const MISSING = -32768;

/** Reads the document and inflates its block; see fpcad/look/pack.py. */
export async function readRun() {
  const run = JSON.parse(document.getElementById("run").textContent);
  return unpack(run, document.getElementById("block").textContent.trim());
}

/** Puts the numbers of a block [base64] in the places of the references to them. */
export async function unpack(told, block) {
  resolve(told, await inflate(block));
  return told;
}

async function inflate(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Puts arrays in the place of all references. */
function resolve(node, block) {
  for (const [key, value] of Object.entries(node)) {
    if (value === null || typeof value !== "object") continue;
    if (Number.isInteger(value.at) && value.type in TYPES) node[key] = decode(value, block);
    else resolve(value, block);
  }
}

function decode(reference, block) {
  const steps = joinPlanes(reference, block);
  const values = "scale" in reference ? dequantize(reference, steps) : steps;
  return Object.assign(values, { shape: reference.shape });
}

function joinPlanes({ at, n, type }, block) {
  const Type = TYPES[type];
  const size = Type.BYTES_PER_ELEMENT;
  const bytes = new Uint8Array(n * size);
  for (let plane = 0; plane < size; plane++) {
    const from = at + plane * n;
    for (let i = 0; i < n; i++) bytes[i * size + plane] = block[from + i];
  }
  return new Type(bytes.buffer);
}

function dequantize({ scale, offset, shape, delta }, steps) {
  if (delta) {
    const width = shape[shape.length - 1];
    for (let i = 0; i < steps.length; i++) if (i % width) steps[i] += steps[i - 1];
  }
  const values = new Float32Array(steps.length); // loops: `from` with a function is ten times slower
  for (let i = 0; i < values.length; i++) values[i] = steps[i] === MISSING ? NaN : offset + scale * steps[i];
  return values;
}
