import { describe, expect, it } from 'vitest'
import { prices } from '../model/fixtures/tiny'
import { NONE } from '../model/motion'
import { timeOf } from '../model/time'
import { fit } from './camera'
import { pick } from './pick'
import { boxOf } from './plane'
import { Scene } from './scene'
import { aircraftPixel, vertiportPixel, visibility } from './where'

const size = { width: 800, height: 600 }

function at(clock: string): Scene {
  const scene = new Scene(prices())
  scene.show(timeOf(clock))
  return scene
}

describe('a scene', () => {
  it('counts every aircraft at exactly one vertiport', () => {
    const scene = at('07:05:00')
    const stands = scene.room.map((_, one) => scene.counts.standsOf(one))
    expect(stands).toEqual([
      { taken: 0, promised: 2, overdue: 0 },
      { taken: 0, promised: 1, overdue: 0 },
      { taken: 0, promised: 0, overdue: 0 },
    ])
    expect(scene.aircraftAt(0).map(({ aircraft }) => aircraft)).toEqual([1, 2])
  })

  it('has destinations of flights, and none of standing aircraft', () => {
    const scene = at('07:15:30')
    expect(scene.destination(0)).toBe(NONE)
    expect(scene.origin(0)).toBe(NONE)
    expect(at('07:05:00').destination(0)).toBe(1)
    expect(at('07:05:00').origin(0)).toBe(2)
    expect(at('07:26:00').load(1)).toBe(0.25)
  })

  it('contains closures', () => {
    expect(at('07:29:59').closures).toHaveLength(0)
    expect(at('07:30:00').closures).toHaveLength(2)
    expect(at('08:00:00').closures).toHaveLength(0)
  })

  it('changes its revision only when more than positions have changed', () => {
    const scene = at('07:05:00')
    const before = scene.revision
    scene.show(timeOf('07:06:00'))
    expect(scene.revision).toBe(before)
    scene.show(timeOf('07:19:21'))
    expect(scene.revision).toBeGreaterThan(before)
  })

  it('changes its revision at a take-off, though the stand at the destination was promised before', () => {
    const scene = at('07:04:00')
    const { revision, inTheAir } = scene.counts
    const promised = scene.room.map((_, one) => scene.counts.standsOf(one))
    scene.show(timeOf('07:05:00'))
    expect(scene.room.map((_, one) => scene.counts.standsOf(one))).toEqual(promised)
    expect(scene.counts.inTheAir).toBe(inTheAir + 1)
    expect(scene.counts.revision).toBeGreaterThan(revision)
  })

  it('shows the given waiting passengers, if there are any', () => {
    const scene = at('07:05:00')
    scene.show(timeOf('07:05:00'), [{ from: 0, to: 1, passengers: 3 }])
    expect(scene.pairs).toEqual([{ from: 0, to: 1, passengers: 3 }])
  })
})

describe('the pointer', () => {
  const scene = at('07:04:00')
  const viewpoint = { scene, size, camera: fit(boxOf(scene.plane.vertiports), size) }

  it('finds aircraft in the air before vertiports', () => {
    expect(pick(viewpoint, aircraftPixel(viewpoint, 0))).toEqual({ kind: 'aircraft', aircraft: 0 })
    expect(pick(viewpoint, vertiportPixel(viewpoint, 2))).toEqual({ kind: 'vertiport', vertiport: 2 })
    expect(pick(viewpoint, { x: 1, y: 1 })).toBeUndefined()
  })

  it('finds a delayed aircraft next to its vertiport, on the side of its destination', () => {
    const [place, vertiport, destination] = [
      aircraftPixel(viewpoint, 1),
      vertiportPixel(viewpoint, 1),
      vertiportPixel(viewpoint, 0),
    ]
    expect(visibility(viewpoint, 1, place)).toBe(1)
    expect(Math.sign(place.x - vertiport.x)).toBe(Math.sign(destination.x - vertiport.x))
    expect(pick(viewpoint, place)).toEqual({ kind: 'aircraft', aircraft: 1 })
  })

  it('does not find aircraft that have faded into a ring', () => {
    const landing = at('07:10:50')
    const there = { ...viewpoint, scene: landing }
    expect(visibility(there, 0, aircraftPixel(there, 0))).toBe(0)
    expect(pick(there, vertiportPixel(there, 1))).toEqual({ kind: 'vertiport', vertiport: 1 })
  })
})
