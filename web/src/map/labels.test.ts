import { expect, it } from 'vitest'
import { placeLabels, type LabelWish } from './labels'

const size = { width: 400, height: 300 }
const wish = (x: number, y: number, weight = 1): LabelWish => ({
  x,
  y,
  radius: 10,
  width: 40,
  height: 20,
  weight,
})

it('a name is to the right of its ring', () => {
  expect(placeLabels([wish(100, 100)], size)).toEqual([{ left: 115, top: 90 }])
})

it('a name avoids other rings and the edge of the picture', () => {
  const [first, second] = placeLabels([wish(100, 100), wish(130, 100)], size)
  expect(first?.left).toBeLessThan(100)
  expect(second?.left).toBeGreaterThan(130)
  expect(placeLabels([wish(390, 100)], size)[0]?.left).toBeLessThan(390)
})

it('a name avoids covered parts of the picture', () => {
  const covered = [{ left: 110, top: 0, right: 400, bottom: 300 }]
  expect(placeLabels([wish(100, 100)], size, covered)[0]?.left).toBe(45)
})

it('names without room are left out, those of less weight first', () => {
  const crowd = Array.from({ length: 9 }, (_, one) =>
    wish(100 + (one % 3) * 14, 100 + Math.floor(one / 3) * 14, one),
  )
  const places = placeLabels(crowd, size)
  expect(places[8]).toBeDefined()
  expect(places.filter((place) => place === undefined).length).toBeGreaterThan(0)
})
