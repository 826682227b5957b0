// Named columns of one run of bytes, as opsim/viewer/columns.py lays them: little-endian, the lowest byte of every
// number first, then the next lowest. A column is put together when it is first asked for, and then kept.

const KINDS = {
  f8: Float64Array,
  f4: Float32Array,
  u4: Uint32Array,
  i4: Int32Array,
  u2: Uint16Array,
  i2: Int16Array,
  u1: Uint8Array,
  i1: Int8Array,
};

/** An object with a typed array for each name of a table {name: [kind, byte offset, count]}. */
export function columnsOf(buffer, table) {
  const columns = {};
  for (const [name, [kind, offset, count]] of Object.entries(table)) {
    const get = () => {
      const value = column(buffer, kind, offset, count);
      Object.defineProperty(columns, name, { value, enumerable: true });
      return value;
    };
    Object.defineProperty(columns, name, { get, configurable: true, enumerable: true });
  }
  return columns;
}

function column(buffer, kind, offset, count) {
  const Kind = KINDS[kind],
    size = Kind.BYTES_PER_ELEMENT,
    planes = new Uint8Array(buffer, offset, size * count);
  if (size === 1) return new Kind(buffer, offset, count); // nothing is out of place: a view, not a copy
  const numbers = new Uint8Array(size * count);
  for (let plane = 0; plane < size; plane++)
    for (let i = 0, from = plane * count, to = plane; i < count; i++, to += size) numbers[to] = planes[from + i];
  return new Kind(numbers.buffer);
}

/** The columns of a model under the model's own words, each still put together only when it is asked for. */
export function columnsOfModel(columns, model) {
  const own = {};
  for (const [word, name] of Object.entries(model.columns))
    Object.defineProperty(own, word, { get: () => columns[name], enumerable: true });
  return own;
}

/** The last row of sorted[low, high) that is not after x; low where all are. */
export function rowAt(sorted, low, high, x) {
  let first = low,
    last = high - 1;
  while (first < last) {
    const middle = (first + last + 1) >> 1;
    if (sorted[middle] <= x) first = middle;
    else last = middle - 1;
  }
  return first;
}
