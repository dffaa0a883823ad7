// Encodes lines and rings of the base map as text. Each point is the difference to the previous
// one, in thousandths of a degree, with five bits per letter. The build writes this text and the
// map reads it.

const LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_'
const CODES = new Map(Array.from(LETTERS, (letter, code) => [letter, code]))
/** Units per degree: one is about a hundred metres, which is finer than the source. */
const UNITS = 1000

/**
 * Encodes points in degrees as text, relative to an origin in degrees. Points equal to the previous
 * one are left out.
 */
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

/**
 * Encodes an integer, lowest bits first. Its lowest bit is the sign, and a letter's highest bit
 * means that more letters follow.
 */
function letters(number: number): string {
  let rest = number < 0 ? -2 * number - 1 : 2 * number
  let text = ''
  while (rest >= 32) {
    text += LETTERS.charAt(32 + (rest & 31))
    rest >>= 5
  }
  return text + LETTERS.charAt(rest)
}

/** Decodes text to points in degrees, two numbers each. */
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
