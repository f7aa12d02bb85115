// The run's document and the blocks of numbers that it refers to.

const TYPES = { f4: Float32Array, i2: Int16Array, i4: Int32Array, u1: Uint8Array };
const MISSING = -32768;
const OPENING = "opening", LATER = ["hands", "paths"]; // as in fpcad/look/document.py
const PATIENCE_MS = 12; // decoding lets the reader's clicks in so often

/** Reads the document and its first block, of what the page opens with: a plain one, see fpcad/look/pack.py. */
export function readRun() {
  const run = JSON.parse(document.getElementById("run").textContent);
  const bytes = bytesOf(textOf(OPENING));
  for (const [place, key] of referencesTo(run, OPENING)) place[key] = decode(place[key], viewOf(place[key], bytes));
  return Object.assign(run, { isWhole: false });
}

/** Reads the other blocks when the browser has come to their end. */
export async function readRest(run) {
  if (document.readyState === "loading")
    await new Promise((done) => document.addEventListener("DOMContentLoaded", done, { once: true }));
  for (const name of LATER) await unpack(run, name, textOf(name));
  run.isWhole = true;
}

function textOf(block) {
  const element = document.getElementById(`block-${block}`);
  const text = element.textContent.trim();
  element.remove(); // megabytes that nobody needs any more
  return text;
}

/** Puts the numbers of a block [base64] in the places of the references to them. */
export async function unpack(told, name, base64) {
  const bytes = await inflate(base64);
  let last = performance.now();
  for (const [place, key] of referencesTo(told, name)) {
    place[key] = decode(place[key], joinPlanes(place[key], bytes));
    if (performance.now() - last > PATIENCE_MS) {
      await new Promise((done) => setTimeout(done));
      last = performance.now();
    }
  }
  return told;
}

async function inflate(base64) {
  const stream = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** All [object, key] that hold a reference into a block. */
function referencesTo(node, name, found = []) {
  if (ArrayBuffer.isView(node)) return found;
  for (const [key, value] of Object.entries(node)) {
    if (value === null || typeof value !== "object") continue;
    if (!(value.type in TYPES)) referencesTo(value, name, found);
    else if (value.in === name) found.push([node, key]);
  }
  return found;
}

function decode(reference, steps) {
  const values = "scale" in reference ? dequantize(reference, steps) : steps;
  return Object.assign(values, { shape: reference.shape });
}

function viewOf({ at, n, type }, block) {
  return new TYPES[type](block.buffer, block.byteOffset + at, n);
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
