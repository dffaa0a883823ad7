// Places the names of vertiports on the map. Each is next to its ring, where it covers neither
// another ring nor another name. A name without room is left out; the tooltip of the ring still
// shows it.

import type { Size } from '../parts/sheet'

export interface LabelWish {
  /** The centre of the labelled ring, pixels. */
  x: number
  y: number
  radius: number
  width: number
  height: number
  /** Higher weights are placed first. */
  weight: number
}

export interface LabelPlace {
  /** The top left corner of the text. */
  left: number
  top: number
}

const GAP = 5

export interface Rectangle {
  left: number
  top: number
  right: number
  bottom: number
}

/**
 * The position of each name within a picture, of which some parts are covered; undefined if there
 * is no room.
 */
export function placeLabels(
  wishes: readonly LabelWish[],
  size: Size,
  covered: readonly Rectangle[] = [],
): (LabelPlace | undefined)[] {
  const rings = wishes.map(({ x, y, radius }) => around(x, y, radius, radius))
  const taken = [...covered]
  const places = new Array<LabelPlace | undefined>(wishes.length).fill(undefined)
  const order = wishes
    .map((wish, index) => ({ wish, index }))
    .sort((one, other) => other.wish.weight - one.wish.weight)
  for (const { wish, index } of order) {
    const others = rings.filter((_, ring) => ring !== index)
    const isFree = (one: Rectangle) =>
      isWithin(one, size) && ![...taken, ...others].some((other) => overlap(one, other))
    const found = candidates(wish).find(isFree)
    if (found === undefined) continue
    taken.push(found)
    places[index] = { left: found.left, top: found.top }
  }
  return places
}

/** To the right, to the left, below and above, in this order. */
function candidates({ x, y, radius, width, height }: LabelWish): Rectangle[] {
  const [aside, away] = [radius + GAP + width / 2, radius + GAP / 2 + height / 2]
  const [half, tall] = [width / 2, height / 2]
  return [
    around(x + aside, y, half, tall),
    around(x - aside, y, half, tall),
    around(x, y + away, half, tall),
    around(x, y - away, half, tall),
  ]
}

function around(x: number, y: number, half: number, tall: number): Rectangle {
  return { left: x - half, top: y - tall, right: x + half, bottom: y + tall }
}

function isWithin({ left, top, right, bottom }: Rectangle, { width, height }: Size): boolean {
  return left >= 0 && top >= 0 && right <= width && bottom <= height
}

function overlap(one: Rectangle, other: Rectangle): boolean {
  return one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom
}
