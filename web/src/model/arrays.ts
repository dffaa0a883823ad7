// Access to arrays at positions that are known to exist. TypeScript would require a check at every
// access, and pictures read some thousand numbers a frame.

/** No index: an aircraft without a leg, or one in the air and thus at no vertiport. */
export const NONE = -1

/** The element at a position that exists. */
export function at<T>(array: ArrayLike<T>, index: number): T {
  return array[index] as T
}

/** How many of the first `size` sorted values, from `offset` on, are at most a value. */
export function countUpTo(
  values: ArrayLike<number>,
  value: number,
  offset = 0,
  size = values.length - offset,
): number {
  let [low, high] = [0, size]
  while (low < high) {
    const middle = (low + high) >> 1
    if (at(values, offset + middle) <= value) low = middle + 1
    else high = middle
  }
  return low
}

/** Groups the elements of a list by a key, in the order of the list. */
export function grouped<T, K>(list: readonly T[], keyOf: (one: T) => K): Map<K, T[]> {
  const groups = new Map<K, T[]>()
  for (const one of list) {
    const key = keyOf(one)
    const group = groups.get(key)
    if (group === undefined) groups.set(key, [one])
    else group.push(one)
  }
  return groups
}

/** The sum of values. */
export function total(values: readonly number[]): number {
  return values.reduce((sum, one) => sum + one, 0)
}
