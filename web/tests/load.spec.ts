// The download before a dispatcher can work: kept small, so that the console loads fast on a poor
// connection.

import { gzipSync } from 'node:zlib'
import { expect, open, panel, test } from './support/test'

const MOST_BYTES = 1_000_000

test('the first load of the console is at most a megabyte, compressed', async ({ page, program, fleet }) => {
  const files = new Map<string, number>()
  const reading: Promise<void>[] = []
  page.on('response', (response) => {
    const { pathname } = new URL(response.url())
    if (pathname.startsWith('/v1')) return
    const read = response.body().then((body) => files.set(pathname, gzipSync(body).length))
    reading.push(read.then(() => undefined))
  })
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await expect(page.getByRole('region', { name: 'Map' }).first()).toBeVisible()
  // The stream of events never ends, so the network is never idle.
  await page.waitForTimeout(1500)
  await Promise.all(reading)
  const bytes = [...files.values()].reduce((sum, one) => sum + one, 0)
  console.log(`first load: ${files.size} files, ${Math.round(bytes / 1000)} kB compressed`)
  // At least the page, its script and style, the map and the timeline.
  expect(files.size).toBeGreaterThan(6)
  expect(bytes).toBeLessThan(MOST_BYTES)
})
