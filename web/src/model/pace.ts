// How fast a day passes. Events say what time it was when they came; between them the clock goes on at the speed that was
// observed, so that movement is smooth. It waits for news if none comes, and never runs back unless it turns out that time stands
// still: a simulated day waits for people, or nothing more is heard of it. The clock then is at the latest time that is known.

import type { Seconds } from './record'

/** What is looked back on to see the speed: long enough for a few events of a quiet day at its own speed. */
export const LOOK_BACK_MS = 60_000
/** News of a shorter time says nothing about the speed: events come in bursts. */
const LEAST_OBSERVED_MS = 1_000
/** How long the clock takes to make up for what news says: fast enough to be right, slow enough not to jump. */
const CATCH_UP_MS = 700
/** A clock that is further behind than this, in its own time, jumps: a person has come back to the page. */
const JUMP_MS = 4_000
/** How much longer than the longest silence so far the clock goes on without news. */
const PATIENCE = 1.5
const LEAST_PATIENCE_MS = 1_500
/** A day that passes faster than this is simulated, and waits where people are to decide: its clock goes on for less long. */
const SIMULATED = 2
const MOST_AHEAD_S = 120
/** A day of which nothing is heard for so many times as long as the clock goes on without news stands still. */
const STILL = 2
const LEAST_STILL_MS = 5_000

interface News {
  time: Seconds
  at_ms: number
}

export class Pace {
  #news: News[] = []
  #shown: News | undefined
  /** Whether aircraft wait for people. A simulated day then stands still; a day that happens does not. */
  isAwaited = false

  /** Takes the news that the day was at a time. News of the same or an earlier time says nothing. */
  hear(time: Seconds, at_ms: number): void {
    const latest = this.#news.at(-1)
    if (latest !== undefined && time <= latest.time) return
    this.#news.push({ time, at_ms })
    const old = this.#news.findIndex((news) => news.at_ms >= at_ms - LOOK_BACK_MS)
    if (old > 0) this.#news = this.#news.slice(Math.max(0, Math.min(old, this.#news.length - 2)))
  }

  /** Seconds of the day that pass in a second; 0 while nothing is known. */
  get speed(): number {
    const [first, last] = [this.#news[0], this.#news.at(-1)]
    if (first === undefined || last === undefined || last.at_ms - first.at_ms < LEAST_OBSERVED_MS) return 0
    return ((last.time - first.time) / (last.at_ms - first.at_ms)) * 1000
  }

  /** The latest time that is known; undefined while nothing is. */
  get latest(): Seconds | undefined {
    return this.#news.at(-1)?.time
  }

  /** The day is over at a time: the clock stops there. */
  end(time: Seconds, at_ms: number): void {
    this.#news = [{ time, at_ms }]
    this.#shown = { time, at_ms }
  }

  /** Whether a simulated day has said nothing for so long that its time evidently does not pass. */
  isStill(now_ms: number): boolean {
    const latest = this.#news.at(-1)
    if (latest === undefined || this.speed <= SIMULATED) return false
    return now_ms - latest.at_ms > Math.max(LEAST_STILL_MS, STILL * this.#patience())
  }

  /** The time to show. */
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
    const silence_ms = Math.min(Math.max(0, now_ms - latest.at_ms), this.#patience())
    return latest.time + (this.speed * silence_ms) / 1000
  }

  #patience(): number {
    const silences = this.#news.slice(1).map((news, at) => news.at_ms - (this.#news[at]?.at_ms ?? news.at_ms))
    const patience_ms = Math.max(LEAST_PATIENCE_MS, PATIENCE * Math.max(0, ...silences))
    return this.speed > SIMULATED ? Math.min(patience_ms, (1000 * MOST_AHEAD_S) / this.speed) : patience_ms
  }

  #isFarBehind(shown: News, target: Seconds): boolean {
    return target - shown.time > Math.max(1, this.speed) * (JUMP_MS / 1000) && target - shown.time > 5
  }
}
