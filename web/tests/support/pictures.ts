// Pages for tests of pictures: one picture of a day, served from the sources; and the replay page
// of a report, opened from disk.

import { execFileSync } from 'node:child_process'
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join, resolve } from 'node:path'
import { pathToFileURL } from 'node:url'
import { test as base, type Page } from '@playwright/test'
import { createServer, type ViteDevServer } from 'vite'
import { chromium } from './browsers'
import { program } from './program'
import { useOneFont } from './screens'

export { expect } from '@playwright/test'
export { expectAccessible, expectAccessibleInBoth } from './test'

const fixtures = resolve('src/model/fixtures')
const large = resolve('../networks/large.toml')

/** WebGL on the main processor. */
export const withWebGL = { executablePath: chromium, args: ['--no-sandbox', '--enable-unsafe-swiftshader'] }

/** The shipped network `large` with 200 aircraft. */
export function networkOfTwoHundred(): string {
  return readFileSync(large, 'utf8')
    .replaceAll('count = 150', 'count = 100')
    .replace('name = "large"', 'name = "two-hundred"')
}

/** A folder with days that the program has drawn and played. */
export class Days {
  readonly folder = mkdtempSync(join(tmpdir(), 'vertifleet-days-'))

  run(...args: string[]): void {
    execFileSync(program, args, { cwd: this.folder, stdio: 'pipe' })
  }

  /** Draws a day of a network and plays it; its files are `name.json` and `name.csv`. */
  make(name: string, network: string, policy = 'prices'): void {
    this.run('scenario', network, '--seed', '100', '-o', `${name}.json`)
    this.run('simulate', `${name}.json`, '--policy', policy, '--trace', `${name}.csv`)
  }

  /** A day of the shipped network `large` with 200 aircraft. */
  makeWithTwoHundredAircraft(name: string): void {
    writeFileSync(join(this.folder, 'two-hundred.toml'), networkOfTwoHundred())
    this.make(name, 'two-hundred.toml')
  }

  path(file: string): string {
    return join(this.folder, file)
  }

  remove(): void {
    rmSync(this.folder, { recursive: true, force: true })
  }
}

interface WorkerFixtures {
  days: Days
  server: ViteDevServer
}

interface Fixtures {
  /** Shows one picture of a day: `picture=map&day=new-york&at=08:20:00`. */
  show: (query: string) => Promise<void>
  pageErrors: string[]
}

export const test = base.extend<Fixtures, WorkerFixtures>({
  days: [
    // eslint-disable-next-line no-empty-pattern -- Playwright requires a pattern.
    async ({}, use) => {
      const days = new Days()
      await use(days)
      days.remove()
    },
    { scope: 'worker' },
  ],

  server: [
    // eslint-disable-next-line no-empty-pattern -- as above.
    async ({}, use) => {
      const server = await createServer({
        // If Vite discovered these later, it would reload the page during a test.
        optimizeDeps: { include: ['maplibre-gl', 'pmtiles'] },
        server: { port: 0, host: '127.0.0.1', hmr: false },
        logLevel: 'silent',
      })
      await server.listen()
      await use(server)
      await server.close()
    },
    { scope: 'worker' },
  ],

  pageErrors: [
    async ({ context }, use) => {
      const pageErrors: string[] = []
      context.on('weberror', (error) => pageErrors.push(error.error().message))
      await use(pageErrors)
      base.expect(pageErrors).toEqual([])
    },
    { auto: true },
  ],

  page: async ({ page }, use) => {
    await page.addInitScript(useOneFont)
    await use(page)
  },

  show: async ({ page, server, days }, use) => {
    await page.route(
      (url) => url.pathname.startsWith('/days/'),
      (route) =>
        route.fulfill({ path: days.path(new URL(route.request().url()).pathname.slice('/days/'.length)) }),
    )
    await use(async (query) => {
      const asked = new URLSearchParams(query)
      const day = asked.get('day') ?? ''
      const files = `scenario=/days/${day}.json&trace=/days/${day}.csv`
      const [address] = server.resolvedUrls?.local ?? []
      await page.goto(`${address}tests/pages/pictures.html?${files}&${query}`)
      await page.locator('canvas:visible').first().waitFor()
      // The first frame sets the size of the page, the second draws the content.
      for (let frame = 0; frame < 2; frame++)
        await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(drawn)))
    })
  },
})

export function fixture(file: string): string {
  return join(fixtures, file)
}

/**
 * Writes the built replay page with the fixtures' day under both policies, and returns its address.
 */
export function replayOfFixtures(days: Days): string {
  const play = (policy: string, profit_usd: number) => ({
    policy,
    trace: readFileSync(fixture(`tiny-1-${policy}.csv`), 'utf8'),
    profit_usd,
  })
  const scenario = JSON.parse(readFileSync(fixture('tiny-1.json'), 'utf8')) as object
  const plays = [play('prices', 2860.02), play('greedy', 3142.4)]
  const text = JSON.stringify({ days: [{ name: 'tiny-1', scenario, plays }] })
  const place = '<script type="application/json" id="vertifleet-data">'
  const page = readFileSync('dist/replay.html', 'utf8').replace(place, () => place + text)
  writeFileSync(days.path('replay.html'), page)
  return pathToFileURL(days.path('replay.html')).href
}

/** The milliseconds between consecutive frames within a time, sorted. */
export async function frameTimes(page: Page, for_ms: number): Promise<number[]> {
  const times = await page.evaluate(
    (length) =>
      new Promise<number[]>((done) => {
        const passed: number[] = []
        const begin = performance.now()
        let former: number | undefined
        requestAnimationFrame(function step(now) {
          if (former !== undefined) passed.push(now - former)
          former = now
          if (now - begin < length) requestAnimationFrame(step)
          else done(passed)
        })
      }),
    for_ms,
  )
  return times.sort((one, other) => one - other)
}
