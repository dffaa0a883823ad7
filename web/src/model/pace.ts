// The speed of a day. Events carry the time of the day when they arrived. Between events the clock
// runs at the observed speed, so that movement is smooth. Without news it runs on for a limited
// time.
//
// It goes back only if the time of the day turns out to stand still: a simulated day waits for a
// user, or its events stop. The clock then shows the latest known time.

import type { Seconds } from './record'

/** The window for measuring the speed: long enough for a few events of a quiet day in real time. */
export const WINDOW_MS = 60_000
/** News within a shorter time is no measure of the speed, because events come in bursts. */
const LEAST_OBSERVED_MS = 1_000
/**
 * How long the clock takes to correct a difference: short enough to be accurate, long enough not to
 * jump.
 */
const CATCH_UP_MS = 700
/**
 * A clock that is further behind than this, in real time, jumps: the user has returned to the page.
 */
const JUMP_MS = 4_000
/** A step of the day's time is a jump if it is this long, and this many times as fast as before. */
const LEAST_JUMP_S = 120
const JUMP_FACTOR = 20
/** Without news the clock runs this many times as long as the longest silence so far. */
const RUN_ON_FACTOR = 1.5
const LEAST_RUN_ON_MS = 1_500
/**
 * A day that is faster than this is simulated and waits for decisions, so its clock runs on for a
 * shorter time without news.
 */
const SIMULATED = 2
const MOST_AHEAD_S = 120
/** A day stands still after this multiple of the time for which the clock runs without news. */
const STILL_FACTOR = 2
const LEAST_STILL_MS = 5_000
/** With reduced motion, pictures are updated at this interval instead of every frame. */
export const CALM_MS = 1_000

interface News {
  time: Seconds
  at_ms: number
}

export class Pace {
  #news: News[] = []
  #shown: News | undefined
  /** Whether the latest observation was a jump. */
  #hasJumped = false
  /**
   * Whether aircraft wait for decisions. A simulated day then stands still; a real day does not.
   */
  isAwaited = false

  /**
   * Adds an observation of the day's time. An observation of the same or an earlier time is
   * ignored.
   */
  observe(time: Seconds, at_ms: number): void {
    const latest = this.#news.at(-1)
    if (latest !== undefined && time <= latest.time) return
    const isJump = latest !== undefined && this.#isJump(latest, { time, at_ms })
    // Two in sequence are the speed of a fast day.
    if (isJump && !this.#hasJumped) this.#news = []
    this.#hasJumped = isJump && !this.#hasJumped
    this.#news.push({ time, at_ms })
    const old = this.#news.findIndex((news) => news.at_ms >= at_ms - WINDOW_MS)
    if (old > 0) this.#news = this.#news.slice(Math.max(0, Math.min(old, this.#news.length - 2)))
  }

  /**
   * Whether the time was set forward, as by a report of the clock. Such a step is no measure of the
   * speed.
   */
  #isJump(latest: News, { time, at_ms }: News): boolean {
    const step_s = time - latest.time
    const passed_s = Math.max(LEAST_OBSERVED_MS, at_ms - latest.at_ms) / 1000
    return step_s > LEAST_JUMP_S && step_s > JUMP_FACTOR * Math.max(1, this.speed) * passed_s
  }

  /** Seconds of the day per second; 0 while unknown. */
  get speed(): number {
    const [first, last] = [this.#news[0], this.#news.at(-1)]
    if (first === undefined || last === undefined || last.at_ms - first.at_ms < LEAST_OBSERVED_MS) return 0
    return ((last.time - first.time) / (last.at_ms - first.at_ms)) * 1000
  }

  /** The latest known time; undefined if there is none. */
  get latest(): Seconds | undefined {
    return this.#news.at(-1)?.time
  }

  /** The day is over at a time; the clock stops there. */
  end(time: Seconds, at_ms: number): void {
    this.#news = [{ time, at_ms }]
    this.#shown = { time, at_ms }
  }

  /** Whether a simulated day has been silent for so long that its time evidently stands still. */
  isStill(now_ms: number): boolean {
    const latest = this.#news.at(-1)
    if (latest === undefined || this.speed <= SIMULATED) return false
    return now_ms - latest.at_ms > Math.max(LEAST_STILL_MS, STILL_FACTOR * this.#runOn_ms())
  }

  /** The time to display. */
  at(now_ms: number): Seconds {
    const latest = this.#news.at(-1)
    if (latest !== undefined && this.speed > SIMULATED && (this.isAwaited || this.isStill(now_ms))) {
      this.#shown = { time: latest.time, at_ms: now_ms }
      return latest.time
    }
    const target = this.#expected(now_ms)
    const shown = this.#shown
    if (shown === undefined || this.#isFarBehind(shown, target)) {
      this.#shown = { time: target, at_ms: now_ms }
      return target
    }
    const gap = this.#expected(shown.at_ms) - shown.time
    const left = gap * Math.exp(-Math.max(0, now_ms - shown.at_ms) / CATCH_UP_MS)
    const time = Math.max(shown.time, target - left)
    this.#shown = { time, at_ms: now_ms }
    return time
  }

  #expected(now_ms: number): Seconds {
    const latest = this.#news.at(-1)
    if (latest === undefined) return this.#shown?.time ?? 0
    const silence_ms = Math.min(Math.max(0, now_ms - latest.at_ms), this.#runOn_ms())
    return latest.time + (this.speed * silence_ms) / 1000
  }

  #runOn_ms(): number {
    const silences = this.#news.slice(1).map((news, at) => news.at_ms - (this.#news[at]?.at_ms ?? news.at_ms))
    const runOn_ms = Math.max(LEAST_RUN_ON_MS, RUN_ON_FACTOR * Math.max(0, ...silences))
    return this.speed > SIMULATED ? Math.min(runOn_ms, (1000 * MOST_AHEAD_S) / this.speed) : runOn_ms
  }

  #isFarBehind(shown: News, target: Seconds): boolean {
    return target - shown.time > Math.max(1, this.speed) * (JUMP_MS / 1000) && target - shown.time > 5
  }
}
