// A minimal PMTiles file: one vector tile of the whole world, with water in the west of it. The
// format is that of https://github.com/protomaps/PMTiles/blob/main/spec/v3/spec.md, the tile that
// of the Mapbox Vector Tile specification 2.1.

const HEADER_BYTES = 127
const EXTENT = 4096
const NO_COMPRESSION = 1
const VECTOR = 1

/** The file, with water from the edge of the map at 180° west to a longitude. */
export function worldWithWaterWestOf(longitude: number): Buffer {
  const tile = waterTile(Math.round(((longitude + 180) / 360) * EXTENT))
  // One entry: tile 0, run length 1, its length in bytes, at the first byte (written as 1).
  const directory = Buffer.from([
    ...varint(1),
    ...varint(0),
    ...varint(1),
    ...varint(tile.length),
    ...varint(1),
  ])
  const metadata = Buffer.from(
    JSON.stringify({ attribution: 'A survey', vector_layers: [{ id: 'water', fields: {} }] }),
  )
  const header = Buffer.alloc(HEADER_BYTES)
  header.write('PMTiles')
  header[7] = 3
  let offset = HEADER_BYTES
  // The offset and length of each part: the directory, the metadata, further directories, the
  // tiles.
  for (const [index, length] of [directory.length, metadata.length, 0, tile.length].entries()) {
    header.writeBigUInt64LE(BigInt(offset), 8 + 16 * index)
    header.writeBigUInt64LE(BigInt(length), 16 + 16 * index)
    offset += length
  }
  for (const count of [72, 80, 88]) header.writeBigUInt64LE(1n, count)
  header[96] = 1
  header[97] = NO_COMPRESSION
  header[98] = NO_COMPRESSION
  header[99] = VECTOR
  for (const [index, degrees] of [-180, -85, 180, 85].entries())
    header.writeInt32LE(degrees * 1e7, 102 + 4 * index)
  return Buffer.concat([header, directory, metadata, tile])
}

/** A tile with one rectangle of water, from its western edge to a column. */
function waterTile(east: number): Buffer {
  const geometry = [
    ...[9, 0, 0],
    ...[26, zigzag(east), 0, 0, zigzag(EXTENT), zigzag(-east), 0],
    // Closes the ring.
    15,
  ].flatMap(varint)
  const feature = [...number(3, 3), ...bytes(4, geometry)]
  const layer = [
    ...number(15, 2),
    ...bytes(1, [...Buffer.from('water')]),
    ...bytes(2, feature),
    ...number(5, EXTENT),
  ]
  return Buffer.from(bytes(3, layer))
}

/** A numeric member of a protocol buffer. */
function number(member: number, value: number): number[] {
  return [...varint(member << 3), ...varint(value)]
}

/** A member of a protocol buffer with bytes. */
function bytes(member: number, value: number[]): number[] {
  return [...varint((member << 3) | 2), ...varint(value.length), ...value]
}

function varint(value: number): number[] {
  return value < 0x80 ? [value] : [(value & 0x7f) | 0x80, ...varint(value >>> 7)]
}

function zigzag(value: number): number {
  return value < 0 ? -2 * value - 1 : 2 * value
}
