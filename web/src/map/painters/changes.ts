// Detects changes of a layer's dependencies, so that unchanged layers are not drawn again.

/**
 * Returns a function that reports whether a layer's dependencies differ from the previous picture.
 */
export function changed<P>(dependencies: (picture: P) => readonly unknown[]): (picture: P) => boolean {
  let former: readonly unknown[] = []
  return (picture) => {
    const now = dependencies(picture)
    const isSame = now.length === former.length && now.every((one, index) => one === former[index])
    former = now
    return !isSame
  }
}
