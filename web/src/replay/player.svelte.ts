// Playback of a day: a clock that a user can start, stop, speed up and move.

import { countUpTo } from '../model/arrays'
import { CALM_MS } from '../model/pace'
import type { Seconds } from '../model/record'

/** Seconds of the day per second. */
export const SPEEDS = { least: 1, most: 3600, first: 300 }

export interface Span {
  from: Seconds
  to: Seconds
}

export class Player {
  time = $state<Seconds>(0)
  speed = $state(SPEEDS.first)
  isPlaying = $state(false)
  #span: Span = { from: 0, to: 0 }

  get span(): Span {
    return this.#span
  }

  /** Loads another day; the time is kept if it lies within it. */
  load(span: Span): void {
    this.#span = span
    this.time = this.time < span.from || this.time > span.to ? span.from : this.time
  }

  toggle(): void {
    if (!this.isPlaying && this.time >= this.#span.to) this.time = this.#span.from
    this.isPlaying = !this.isPlaying
  }

  seek(time: Seconds): void {
    this.time = Math.max(this.#span.from, Math.min(this.#span.to, time))
  }

  /** Moves to the next or previous of the given times, and stops there. */
  step(times: ArrayLike<Seconds>, direction: 1 | -1): void {
    this.isPlaying = false
    const passed = direction === 1 ? countUpTo(times, this.time) : countUpTo(times, this.time - 1e-6) - 1
    const time = times[passed]
    if (time !== undefined) this.seek(time)
  }

  setSpeed(speed: number): void {
    this.speed = Math.max(SPEEDS.least, Math.min(SPEEDS.most, Math.round(speed)))
  }

  /** Runs until the returned function is called. */
  run(): () => void {
    const calm = matchMedia('(prefers-reduced-motion: reduce)')
    let former: number | undefined
    const step = (now: number) => {
      frame = requestAnimationFrame(step)
      const passed_ms = now - (former ?? now)
      if (calm.matches && former !== undefined && passed_ms < CALM_MS) return
      former = now
      if (this.isPlaying) this.#goOn((passed_ms / 1000) * this.speed)
    }
    let frame = requestAnimationFrame(step)
    return () => cancelAnimationFrame(frame)
  }

  #goOn(seconds: number): void {
    this.seek(this.time + seconds)
    if (this.time >= this.#span.to) this.isPlaying = false
  }
}
