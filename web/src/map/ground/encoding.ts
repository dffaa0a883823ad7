// Lines and rings of the base map as text: each point is the difference to the one before it, in thousandths of a degree, in
// five bits a letter. The build writes them and the map reads them.

const LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_'
const CODES = new Map(Array.from(LETTERS, (letter, code) => [letter, code]))
/** Units of a degree: about a hundred metres, which is finer than the source. */
export const UNITS = 1000

/** Points in degrees as text, from an origin in degrees. Points that fall on the one before are left out. */
export function encode(
  points: readonly (readonly [number, number])[],
  origin: readonly [number, number],
): string {
  let text = ''
  let former: [number, number] = [0, 0]
  points.forEach(([x, y], index) => {
    const point: [number, number] = [Math.round((x - origin[0]) * UNITS), Math.round((y - origin[1]) * UNITS)]
    if (index > 0 && point[0] === former[0] && point[1] === former[1]) return
    text += letters(point[0] - former[0]) + letters(point[1] - former[1])
    former = point
  })
  return text
}

/** A whole number, lowest bits first; the sign is the lowest bit, and the highest bit of a letter says that more follow. */
function letters(number: number): string {
  let rest = number < 0 ? -2 * number - 1 : 2 * number
  let text = ''
  while (rest >= 32) {
    text += LETTERS.charAt(32 + (rest & 31))
    rest >>= 5
  }
  return text + LETTERS.charAt(rest)
}

/** The points of a text in degrees, two numbers each. */
export function decode(text: string, origin: readonly [number, number]): Float64Array {
  const degrees: number[] = []
  const point: [number, number] = [0, 0]
  let [value, shift] = [0, 0]
  for (const letter of text) {
    const code = CODES.get(letter) ?? 0
    value |= (code & 31) << shift
    shift += 5
    if (code >= 32) continue
    const axis = degrees.length % 2 === 0 ? 0 : 1
    point[axis] += value & 1 ? -((value + 1) >> 1) : value >> 1
    degrees.push(origin[axis] + point[axis] / UNITS)
    value = shift = 0
  }
  return Float64Array.from(degrees)
}
