import { describe, expect, it } from 'vitest'
import { fit, keepNear, pan, pixelX, pixelY, shows, view, zoom } from './camera'

const size = { width: 800, height: 600 }
const box = { west: -10, south: 0, east: 30, north: 20 }

describe('a camera', () => {
  const camera = fit(box, size)

  it('shows all of a box, with room around it', () => {
    for (const [x, y] of [
      [box.west, box.south],
      [box.east, box.north],
    ] as const)
      expect(shows(camera, size, x, y, 40)).toBe(true)
    expect(pixelX(camera, size, 10)).toBe(400)
    expect(pixelY(camera, size, 10)).toBe(300)
  })

  it('has north up', () => {
    expect(pixelY(camera, size, 20)).toBeLessThan(pixelY(camera, size, 0))
  })

  it('keeps the point under the pointer when it zooms', () => {
    const near = zoom(camera, 3, size, 200, 450)
    const there = view(camera, size)
    const x = there.west + 200 / camera.scale
    const y = there.north - 450 / camera.scale
    expect(pixelX(near, size, x)).toBeCloseTo(200)
    expect(pixelY(near, size, y)).toBeCloseTo(450)
  })

  it('moves with the pointer', () => {
    const moved = pan(camera, 50, -20)
    expect(pixelX(moved, size, 10)).toBeCloseTo(450)
    expect(pixelY(moved, size, 10)).toBeCloseTo(280)
  })

  it('keeps a moving point in the middle at its scale, in steps of the pixels that it may be off', () => {
    const moved = keepNear(camera, size, { x: 12, y: 3 }, 1)
    expect(moved).toEqual({ x: 12, y: 3, scale: camera.scale })
    const near = { x: 12 + 0.9 / camera.scale, y: 3 }
    expect(keepNear(moved, size, near, 1)).toBe(moved)
    expect(keepNear(moved, size, { x: 12 + 1.1 / camera.scale, y: 3 }, 1).x).toBeGreaterThan(12)
  })

  it('shows a network of one vertiport at a scale that makes sense', () => {
    expect(fit({ west: 5, south: 5, east: 5, north: 5 }, size).scale).toBeLessThanOrEqual(1000)
  })

  it('neither zooms in nor out without end', () => {
    expect(zoom(camera, 1e9, size).scale).toBe(3000)
    const far = zoom(zoom(camera, 2, size), 1e-9, size, 0, 0, camera)
    expect(far.scale).toBeCloseTo(camera.scale / 10)
  })
})
