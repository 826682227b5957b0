// The bytes of a column block: base64 of gzip in a script element of the page, inflated without being copied about.

const AT_ONCE = 1 << 20; // letters of base64, a multiple of 4

/** An ArrayBuffer of exactly the inflated bytes. Throws where the block is cut short or damaged. */
export async function inflated(element) {
  const text = element.textContent.trim();
  element.textContent = ""; // else the page would hold the whole block twice
  const bytes = new Uint8Array(lengthOf(text));
  const stream = new DecompressionStream("gzip");
  const written = write(stream.writable.getWriter(), text);
  const reader = stream.readable.getReader();
  let at = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    bytes.set(value, at);
    at += value.length;
  }
  await written;
  if (at !== bytes.length) throw new Error("the page is incomplete: a block of motion is cut short");
  return bytes.buffer;
}

async function write(writer, text) {
  for (let at = 0; at < text.length; at += AT_ONCE) {
    await writer.ready;
    writer.write(bytesOf(text.slice(at, at + AT_ONCE)));
  }
  await writer.close();
}

/** gzip says its own length in its last four bytes, modulo 2^32. */
function lengthOf(text) {
  const end = bytesOf(text.slice(-8));
  return new DataView(end.buffer, end.byteOffset).getUint32(end.length - 4, true);
}

export function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes;
}
