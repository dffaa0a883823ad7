// The map and the timelines alone: their look, their use with keys and screen readers, and 200
// moving aircraft on a machine without a graphics processor.

import { expect, expectAccessible, frameTimes, test } from './support/pictures'
import { expectToLook, screens } from './support/screens'

test.beforeAll(({ days }) => {
  days.make('new-york', 'new-york')
  days.make('disrupted', 'disrupted')
})

/**
 * The pictures and screens to test: New York has coasts, and a smaller network has smaller
 * timelines to store.
 */
const pictures = [
  { picture: 'map', day: 'new-york', on: ['desk', 'phone'] },
  { picture: 'fleet', day: 'disrupted', on: ['desk', 'phone'] },
  { picture: 'stands', day: 'disrupted', on: ['desk', 'phone'] },
] as const

test.describe('pictures', () => {
  for (const { picture, day, on } of pictures) {
    for (const screen of on) {
      test(`the ${picture} looks like its screenshot (${screen})`, async ({ page, show }) => {
        await page.setViewportSize(screens[screen])
        await show(`picture=${picture}&day=${day}&at=13:20:00`)
        await expectToLook(page, `${picture}-${screen}`)
      })
    }
  }

  for (const picture of ['map', 'fleet', 'stands']) {
    test(`axe finds no serious problem in the ${picture}`, async ({ page, show }) => {
      await show(`picture=${picture}&day=disrupted&at=10:00:00`)
      await expectAccessible(page)
    })
  }
})

test.describe('the map', () => {
  test.describe('without a graphics processor', () => {
    test('has a text summary, and hides its canvases from screen readers', async ({ page, show }) => {
      await show('picture=map&day=new-york&at=10:31:00')
      const map = page.getByRole('region', { name: 'Map' })
      await expect(
        map.getByText(/A map of 9 vertiports and 32 aircraft. At 10:31: \d+ in the air/),
      ).toBeAttached()
      await expect(map.locator('[aria-hidden=true] canvas').first()).toBeVisible()
    })

    test('zooms and resets, and describes the object under the pointer', async ({ page, show }) => {
      await show('picture=map&day=disrupted&at=10:31:00')
      const all = page.getByRole('button', { name: 'Show all vertiports' })
      await expect(all).toBeDisabled()
      await page.getByRole('button', { name: 'Zoom in' }).click()
      await expect(all).toBeEnabled()
      await all.click()
      await expect(all).toBeDisabled()
      await page.mouse.move(640, 400)
      await page.mouse.wheel(0, -400)
      await expect(all).toBeEnabled()
      await page.mouse.down()
      await page.mouse.move(700, 450, { steps: 4 })
      await page.mouse.up()
      await all.click()
      // V2 is the easternmost vertiport of the network.
      await page.mouse.move(1012, 271)
      await expect(page.getByText(/^\d standing, \d promised, \d of 6 free$/)).toBeVisible()
    })
  })
})

test.describe('a timeline', () => {
  test('is navigated with keys, and announces the selection', async ({ page, show }) => {
    await show('picture=fleet&day=disrupted&at=10:00:00')
    const timeline = page.getByRole('application', { name: /Timeline of the fleet/ })
    await timeline.focus()
    await page.keyboard.press('ArrowRight')
    const announcement = page.locator('[aria-live=polite]')
    await expect(announcement).toContainText('A01')
    const first = await announcement.textContent()
    await page.keyboard.press('ArrowRight')
    await expect(announcement).not.toHaveText(first ?? '')
    await page.keyboard.press('ArrowDown')
    await expect(announcement).toContainText('A02')
    await page.keyboard.press('+')
    await expect(page.getByRole('button', { name: 'Show the whole day' })).toBeEnabled()
    await page.keyboard.press('0')
    await expect(page.getByRole('button', { name: 'Show the whole day' })).toBeDisabled()
  })

  test('can be shown as a table', async ({ page, show }) => {
    await show('picture=fleet&day=disrupted&at=10:00:00')
    await page.getByRole('button', { name: 'As a table' }).click()
    await page.getByLabel('Aircraft', { exact: true }).selectOption('A05')
    const rows = page.getByRole('row')
    await expect(rows.nth(1)).toContainText(/V\d → V\d/)
    expect(await rows.count()).toBeGreaterThan(5)
    await expectAccessible(page)
  })

  test('describes a bar, and selects it', async ({ page, show }) => {
    await show('picture=fleet&day=disrupted&at=10:00:00')
    await page.mouse.move(100, 40)
    await expect(page.getByText(/^A01 · V\d → V\d$/)).toBeVisible()
    await expect(page.getByText(/^flight 06:00:00 to/)).toBeVisible()
  })

  test('zooms with Ctrl and the wheel, and moves with the pointer', async ({ page, show }) => {
    await show('picture=stands&day=disrupted&at=10:00:00')
    await page.mouse.move(640, 300)
    await page.keyboard.down('Control')
    await page.mouse.wheel(0, -200)
    await page.keyboard.up('Control')
    await expect(page.getByRole('button', { name: 'Zoom out' })).toBeEnabled()
    await page.mouse.down()
    await page.mouse.move(500, 300, { steps: 5 })
    await page.mouse.up()
    await page.getByRole('button', { name: 'Show the whole day' }).click()
    await expect(page.getByRole('button', { name: 'Zoom out' })).toBeDisabled()
  })
})

test.describe('200 aircraft', () => {
  test.slow()

  for (const picture of ['map', 'fleet', 'stands']) {
    test(`move on the ${picture}`, async ({ page, show, days }) => {
      days.makeWithTwoHundredAircraft('two-hundred')
      await show(`picture=${picture}&day=two-hundred&at=08:20:00&speed=60`)
      const summary = page.getByText(/^A map of \d+ vertiports and 200 aircraft/)
      if (picture === 'map') await expect(summary).toBeAttached()
      const before = await page.screenshot()
      const times = await frameTimes(page, 2000)
      expect((await page.screenshot()).equals(before)).toBe(false)
      // The speed of a machine is no property of the console, so it is printed and not tested.
      const median_ms = times[Math.floor(times.length / 2)] ?? Infinity
      console.log(`${picture}: ${times.length} frames in 2 s, median ${median_ms.toFixed(1)} ms`)
    })
  }
})
