import { describe, expect, it } from 'vitest'
import { follow, isSameSpan, liveSpan, panSpan, pixelOf, showTime, ticks, timeAt, zoomSpan } from './span'

const whole = { from: 6 * 3600, to: 22 * 3600 }

describe('a span', () => {
  it('keeps the time under the pointer where it is when it zooms', () => {
    const near = zoomSpan(whole, 4, 8 * 3600, whole)
    expect(near.to - near.from).toBe(4 * 3600)
    expect(pixelOf(near, 1000, 8 * 3600)).toBeCloseTo(pixelOf(whole, 1000, 8 * 3600))
  })

  it('never leaves the day', () => {
    expect(zoomSpan(whole, 0.5, 8 * 3600, whole)).toEqual(whole)
    const near = zoomSpan(whole, 16, 14 * 3600, whole)
    expect(panSpan(near, -1e6, whole)).toEqual({ from: whole.from, to: whole.from + 3600 })
    expect(panSpan(near, 1e6, whole)).toEqual({ from: whole.to - 3600, to: whole.to })
  })

  it('is never too short', () => {
    const near = zoomSpan(whole, 1e9, 14 * 3600, whole)
    expect(near.to - near.from).toBe(300)
  })

  it('moves no more than necessary to show a time', () => {
    const near = { from: 10 * 3600, to: 12 * 3600 }
    expect(showTime(near, 11 * 3600, whole)).toBe(near)
    expect(showTime(near, 13 * 3600, whole).to).toBe(13 * 3600 + 720)
    expect(showTime(near, 9 * 3600, whole).from).toBe(9 * 3600 - 720)
  })

  it('follows the displayed time, and no other', () => {
    const near = { from: 10 * 3600, to: 12 * 3600 }
    const edge = near.from + 0.8 * 7200
    expect(follow(near, edge, edge + 10, whole)).toEqual({ from: near.from + 10, to: near.to + 10 })
    expect(follow(near, 9 * 3600, 9 * 3600 + 10, whole)).toBe(near)
    expect(follow(near, edge + 20, edge + 10, whole)).toBe(near)
  })

  it('is unchanged at the end of the day, so that nothing is redrawn', () => {
    const last = { from: 20 * 3600, to: 22 * 3600 }
    expect(follow(last, 21.9 * 3600, 21.91 * 3600, whole)).toBe(last)
  })
})

describe('a live day', () => {
  it('is shown completely if there is room', () => {
    expect(liveSpan(9 * 3600, 1200, whole)).toBe(whole)
  })

  it('is otherwise shown around now, and never beyond its ends', () => {
    const near = liveSpan(12 * 3600, 720, whole)
    expect(near).toEqual({ from: 10 * 3600, to: 18 * 3600 })
    expect(liveSpan(6 * 3600, 720, whole)).toEqual({ from: 6 * 3600, to: 14 * 3600 })
    expect(liveSpan(22 * 3600, 720, whole)).toEqual({ from: 14 * 3600, to: 22 * 3600 })
    expect(isSameSpan(near, whole)).toBe(false)
  })
})

describe('the axis', () => {
  it('labels round times', () => {
    expect(ticks({ from: 6 * 3600 + 1, to: 8 * 3600 }, 240, 60)).toEqual(
      [6.5, 7, 7.5, 8].map((hour) => hour * 3600),
    )
    expect(ticks(whole, 320, 60)).toEqual([6, 9, 12, 15, 18, 21].map((hour) => hour * 3600))
  })

  it('converts pixels to times and back', () => {
    expect(timeAt(whole, 1600, 200)).toBe(8 * 3600)
    expect(pixelOf(whole, 1600, 8 * 3600)).toBe(200)
  })
})
