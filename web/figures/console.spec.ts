// Measures how fast the console loads, how smoothly 200 aircraft move, and whether its memory stays
// flat. It prints the figures, which mean little if the machine is busy with other work.

import type { CDPSession, Page } from '@playwright/test'
import { Fleet } from '../tests/support/fleet'
import { frameTimes, networkOfTwoHundred } from '../tests/support/pictures'
import type { Program } from '../tests/support/program'
import { expect, open, panel, test } from '../tests/support/test'

const LOADS = 11
const SPEED = 60
const FRAMES_MS = 20_000
/** At this speed an hour of the day takes a minute. */
const HOURS = 5
const LOOKS_PER_HOUR = 2

function medianOf(values: number[]): number {
  const sorted = [...values].sort((one, other) => one - other)
  return sorted[Math.floor(sorted.length / 2)] ?? NaN
}

test('first load', async ({ browser, program }) => {
  const fleet = await Fleet.onNewDay(program.url, { network: 'new-york', seed: 3, policy: 'prices' })
  const times: number[] = []
  let bytes = 0
  for (let load = 0; load < LOADS; load++) {
    const context = await browser.newContext({ viewport: { width: 1280, height: 800 } })
    const page = await context.newPage()
    const cdp = await context.newCDPSession(page)
    await cdp.send('Network.enable')
    bytes = 0
    const own = new Set<string>()
    cdp.on('Network.responseReceived', ({ requestId, response }) => {
      if (!new URL(response.url).pathname.startsWith('/v1')) own.add(requestId)
    })
    cdp.on('Network.loadingFinished', ({ requestId, encodedDataLength }) => {
      if (own.has(requestId)) bytes += encodedDataLength
    })
    await page.addInitScript(noteWhenAcceptable)
    await page.goto(`${program.console}/#/day/${fleet.day}/now`)
    await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
    await page.waitForTimeout(1000)
    times.push(await page.evaluate(() => Number(document.documentElement.dataset['acceptable'])))
    await context.close()
  }
  const [median, worst] = [medianOf(times), Math.max(...times)]
  console.log(`first load: ${Math.round(bytes / 1000)} kB, as the service sends it`)
  console.log(
    `the first decision can be accepted after ${Math.round(median)} ms (median of ${LOADS} loads without a cache, at most ${Math.round(worst)} ms)`,
  )
})

/**
 * Records when the first decision can be accepted and two frames have been drawn since. From then
 * on a user can work.
 */
function noteWhenAcceptable(): void {
  const look = () => {
    const accept = document.querySelector<HTMLButtonElement>('.decision .buttons .first')
    if (accept === null || accept.disabled || document.querySelector('.map canvas') === null) {
      requestAnimationFrame(look)
      return
    }
    requestAnimationFrame(() =>
      requestAnimationFrame(
        () => (document.documentElement.dataset['acceptable'] = String(performance.now())),
      ),
    )
  }
  requestAnimationFrame(look)
}

/** Starts an operator with a day of 200 aircraft, and opens it when most of them are in the air. */
async function openBusyDay(page: Page, program: Program): Promise<Fleet> {
  void program.operate(networkOfTwoHundred(), '--policy', 'greedy', '--speed', String(SPEED))
  const fleet = await Fleet.onDayOfOthers(program.url)
  await open(page, program, fleet)
  await expect(page.getByText(/At 06:\d\d: 1\d\d in the air/).first()).toBeAttached({ timeout: 60_000 })
  return fleet
}

test('frames', async ({ page, program }) => {
  await openBusyDay(page, program)
  for (const view of ['now', 'timeline']) {
    await page.evaluate((hash) => (location.hash = hash), new URL(page.url()).hash.replace(/[^/]*$/, view))
    await page.waitForTimeout(3000)
    const times = await frameTimes(page, FRAMES_MS)
    const share = (from_ms: number) => times.filter((one) => one > from_ms).length / times.length
    const shown = (1000 / medianOf(times)).toFixed(0)
    console.log(
      `${view}, 200 aircraft at ${SPEED} times their speed: ${shown} frames/s in the median, ` +
        `${((1000 * times.length) / FRAMES_MS).toFixed(0)} in the mean; ${(100 * share(50)).toFixed(1)} % took more than 50 ms, ` +
        `the longest ${Math.round(times.at(-1) ?? NaN)} ms`,
    )
  }
})

test('memory', async ({ page, context, program }) => {
  const fleet = await openBusyDay(page, program)
  const cdp = await context.newCDPSession(page)
  for (let look = 0; look <= HOURS * LOOKS_PER_HOUR; look++) {
    const { now, seq } = await fleet.state()
    console.log(`${now}, ${seq} events: ${((await heapOf(cdp)) / 1e6).toFixed(1)} MB`)
    await page.waitForTimeout(3_600_000 / SPEED / LOOKS_PER_HOUR)
  }
})

/** Bytes in use after garbage collection. */
async function heapOf(cdp: CDPSession): Promise<number> {
  await cdp.send('HeapProfiler.collectGarbage')
  return (await cdp.send('Runtime.getHeapUsage')).usedSize
}
