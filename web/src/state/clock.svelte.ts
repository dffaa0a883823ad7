// The clock of a live day, updated every frame. It stops while the connection is lost, because
// events in that time are unknown.

import { CALM_MS, Pace } from '../model/pace'
import type { Seconds } from '../model/record'

export class Clock {
  /** The time of the day as text: never before the latest known event. */
  time = $state<Seconds>(0)
  /** The time at which aircraft are drawn: it catches up smoothly instead of jumping. */
  motion = $state<Seconds>(0)
  /** Approximate seconds of the day per second. */
  speed = $state(0)
  /** Whether a simulated day has been silent for so long that its time evidently stands still. */
  isStill = $state(false)
  /** Whether aircraft wait for decisions, so that a simulated day is silent. */
  isAwaited = $state(false)
  #pace = new Pace()
  #frame = 0
  #isHeld = false
  #shown_ms = 0

  /** Adds an observation of the day's time from `age_ms` ago. */
  observe(time: Seconds, age_ms = 0): void {
    this.#pace.observe(time, performance.now() - age_ms)
    if (this.#shown_ms === 0) this.#show(performance.now())
    this.time = Math.max(this.time, this.#pace.latest ?? 0)
    this.speed = this.#pace.speed
  }

  /** Goes back to an earlier time of the day, after a mistaken report was taken back. */
  goBack(time: Seconds): void {
    this.#pace = new Pace()
    this.#pace.isAwaited = this.isAwaited
    this.time = time
    this.observe(time)
    this.#show(performance.now())
  }

  /** Stops at the end of the day. */
  end(time: Seconds): void {
    this.#pace.end(time, performance.now())
    this.#show(performance.now())
    this.speed = 0
    this.isStill = false
  }

  /** Sets whether aircraft wait for decisions. */
  setAwaited(isAwaited: boolean): void {
    this.isAwaited = isAwaited
    this.#pace.isAwaited = isAwaited
  }

  /** Holds the clock while the connection is lost. */
  hold(isHeld: boolean): void {
    this.#isHeld = isHeld
  }

  /** Runs until the returned function is called. */
  run(): () => void {
    const calm = matchMedia('(prefers-reduced-motion: reduce)')
    const step = (now: number) => {
      if (!this.#isHeld && (!calm.matches || now - this.#shown_ms >= CALM_MS)) this.#show(now)
      this.#frame = requestAnimationFrame(step)
    }
    this.#frame = requestAnimationFrame(step)
    return () => cancelAnimationFrame(this.#frame)
  }

  #show(now: number): void {
    this.#shown_ms = now
    this.motion = this.#pace.at(now)
    this.time = Math.max(this.motion, this.#pace.latest ?? 0)
    this.isStill = this.#pace.isStill(now)
  }
}
