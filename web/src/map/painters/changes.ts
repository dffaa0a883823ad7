// Whether anything has changed on which a layer depends: layers that stay the same are not drawn again.

/** Tells, picture by picture, whether what a layer depends on differs from the picture before. */
export function changed<P>(dependencies: (picture: P) => readonly unknown[]): (picture: P) => boolean {
  let former: readonly unknown[] = []
  return (picture) => {
    const now = dependencies(picture)
    const isSame = now.length === former.length && now.every((one, index) => one === former[index])
    former = now
    return !isSame
  }
}
