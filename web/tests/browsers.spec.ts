// The essentials in every supported browser: a report opens from disk and its replay keeps its
// time; the console opens, follows the day, and decides.

import { pathToFileURL } from 'node:url'
import type { Browser, Page } from 'puppeteer-core'
import { others } from './support/browsers'
import { Days, fixture } from './support/pictures'
import { expect, test } from './support/test'

const PATIENCE = { timeout: 20_000 }

/** A page that records its errors. */
async function newPage(browser: Browser): Promise<{ page: Page; pageErrors: string[] }> {
  const page = await browser.newPage()
  await page.setViewport({ width: 1280, height: 800 })
  const pageErrors: string[] = []
  page.on('pageerror', (error) => pageErrors.push(String(error)))
  return { page, pageErrors }
}

for (const [name, launch] of Object.entries(others)) {
  test.describe(name, () => {
    let browser: Browser
    test.beforeAll(async () => {
      browser = await launch()
      console.log(await browser.version())
    })
    test.afterAll(() => browser.close())

    test('opens a report from disk, and its replay keeps its time', async () => {
      const days = new Days()
      try {
        days.run('scenario', fixture('tiny.toml'), '--seed', '1', '-o', 'day.json')
        days.run('simulate', 'day.json', '--policy', 'greedy', '--report', 'day.html')
        const { page, pageErrors } = await newPage(browser)
        await page.goto(pathToFileURL(days.path('day.html')).href)
        const shown = () =>
          page.evaluate(() => {
            const frame = document.querySelector<HTMLIFrameElement>('iframe[title=Replay]')
            frame?.scrollIntoView()
            return frame?.contentDocument?.querySelector('[role=slider]')?.getAttribute('aria-valuetext')
          })
        await expect.poll(shown, PATIENCE).toMatch(/^07:00:00/)
        const replay = await (await page.$('iframe[title=Replay]'))?.contentFrame()
        await replay?.focus('[role=slider]')
        await page.keyboard.press('PageUp')
        await expect.poll(shown, PATIENCE).toMatch(/^07:15:00/)
        await page.keyboard.press('End')
        await expect.poll(shown, PATIENCE).toMatch(/^09:\d\d:\d\d, \$3,142/)
        await expect.poll(() => decodeURIComponent(page.url()), PATIENCE).toMatch(/09:\d\d:\d\d/)
        await page.reload()
        await expect.poll(shown, PATIENCE).toMatch(/\$3,142/)
        expect(pageErrors).toEqual([])
        await page.close()
      } finally {
        days.remove()
      }
    })

    test('follows a day and decides', async ({ program, fleet }) => {
      const { page, pageErrors } = await newPage(browser)
      await page.goto(`${program.console}/#/day/${fleet.day}/now`)
      const words = () => page.evaluate(() => document.body.innerText)
      const summary = () =>
        page.evaluate(() => [...document.querySelectorAll('.map p')].map((one) => one.textContent).join())
      await page.waitForSelector('.advice .first:not(:disabled)', PATIENCE)
      await expect.poll(summary, PATIENCE).toContain('A map of 3 vertiports and 6 aircraft.')
      await page.keyboard.press('a')
      await expect.poll(() => fleet.decisions(), PATIENCE).toBe(1)
      await expect.poll(words, PATIENCE).toMatch(/A01 (flies to|holds at) /)

      // Reports of other users arrive by the stream.
      await fleet.report({ type: 'departed', aircraft: 'A01', time: '06:00:00' })
      await expect.poll(summary, PATIENCE).toContain('1 in the air')
      await fleet.decide('A02', { to: 'North', reason: 'a test' })
      await expect.poll(words, PATIENCE).toMatch(/A02 .*North/)
      await page.reload()
      await expect.poll(summary, PATIENCE).toContain('1 in the air')
      expect(pageErrors).toEqual([])
      await page.close()
    })
  })
}
