// Round steps for grids and scales: 1, 2 and 5 times a power of ten.

/** The smallest round number that is at least this. */
export function roundUp(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least))
  const step = [1, 2, 5, 10].find((one) => one * power >= least * (1 - 1e-9)) ?? 10
  return step * power
}

/** The greatest round number that is at most this. */
export function roundDown(most: number): number {
  const power = 10 ** Math.floor(Math.log10(most))
  const step = [5, 2, 1].find((one) => one * power <= most * (1 + 1e-9)) ?? 1
  return step * power
}

/** The decimal places that multiples of a step need. */
export function digitsOf(step: number): number {
  return Math.max(0, -Math.floor(Math.log10(step) + 1e-9))
}

/** The multiples of a step between two bounds. */
export function multiples(from: number, to: number, step: number): number[] {
  const first = Math.ceil(from / step)
  const count = Math.max(0, Math.floor(to / step) - first + 1)
  return Array.from({ length: count }, (_, index) => (first + index) * step)
}
