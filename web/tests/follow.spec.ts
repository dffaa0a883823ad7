// A dispatcher follows one aircraft: the map and the timeline keep it in view, and its facts stay
// visible, until following ends.

import type { Page } from '@playwright/test'
import { Fleet } from './support/fleet'
import { networkOfTwoHundred } from './support/pictures'
import { expect, expectAccessible, open, panel, test } from './support/test'

/** A01 is on its way from its first vertiport to East, where it lands at 06:41. */
async function sendOff(fleet: Fleet): Promise<void> {
  await fleet.decide('A01', { to: 'East', reason: 'a test' })
  await fleet.report({ type: 'departed', aircraft: 'A01', time: '06:00:00' })
  await fleet.report({ type: 'clock', time: '06:14:00' })
}

async function choose(page: Page, command: string): Promise<void> {
  await page.keyboard.press('Control+k')
  await page.getByRole('combobox', { name: /Find a command/ }).fill(command)
  await page.keyboard.press('Enter')
  await expect(page.getByRole('dialog')).toBeHidden()
}

function facts(page: Page, aircraft = 'A01') {
  return page.getByRole('region', { name: `Aircraft ${aircraft}`, exact: true })
}

async function zoomIn(page: Page, times: number): Promise<void> {
  const button = page
    .getByRole('group', { name: 'Tools of the map' })
    .getByRole('button', { name: 'Zoom in' })
  for (let time = 0; time < times; time++) await button.click()
}

/** The pointer finds an aircraft within this distance. */
const REACH_PX = 12

/** The middle of the map. */
async function middle(page: Page): Promise<{ x: number; y: number }> {
  const box = await page.locator('.ground').boundingBox()
  if (box === null) throw new Error('there is no map')
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 }
}

/** What the map shows in its middle, as the tip at the pointer describes it. */
async function expectInTheMiddle(page: Page, isThere: boolean): Promise<void> {
  const { x, y } = await middle(page)
  await expect(async () => {
    await page.mouse.move(x + 200, y + 100)
    await page.mouse.move(x, y)
    const tip = page.locator('.map .tip').filter({ hasText: 'A01, aircraft of type' })
    // A tip in the corner is about the selection, and not about what is under the pointer.
    const lefts = await tip.evaluateAll((all) => all.map((one) => one.getBoundingClientRect().left))
    expect(lefts.some((left) => left > x - 60)).toBe(isThere)
  }).toPass({ timeout: 15_000 })
}

/** The aircraft is within a quarter of the height of the map from its middle. */
async function expectNearTheMiddle(page: Page): Promise<void> {
  const { x, y } = await middle(page)
  const tip = page.locator('.map .tip').filter({ hasText: 'A01, aircraft of type' })
  const box = await page.locator('.ground').boundingBox()
  const most = (box?.height ?? 0) / 4
  for (let dx = -most; dx <= most; dx += REACH_PX) {
    for (let dy = -most; dy <= most; dy += REACH_PX) {
      await page.mouse.move(x + dx, y + dy)
      const lefts = await tip.evaluateAll((all) => all.map((one) => one.getBoundingClientRect().left))
      if (lefts.some((left) => left > x - most)) return
    }
  }
  throw new Error('the aircraft is not near the middle')
}

test('the map keeps a followed aircraft in its middle until the user moves it', async ({
  page,
  program,
  fleet,
}) => {
  await sendOff(fleet)
  await open(page, program, fleet)
  const summary = page.getByText(/^A map of/)
  await expect(summary).toContainText('At 06:14: 1 in the air')
  await expectInTheMiddle(page, false)

  await choose(page, 'follow a01')
  await expect(facts(page).getByRole('heading', { name: 'Following A01' })).toBeVisible()
  await expectInTheMiddle(page, true)
  await zoomIn(page, 2)
  await expectInTheMiddle(page, true)

  // The aircraft flies on, and the map with it. At its scale it would be outside otherwise.
  await fleet.report({ type: 'clock', time: '06:32:00' })
  await expect(summary).toContainText('At 06:32: 1 in the air')
  await expectInTheMiddle(page, true)

  // Zooming with the wheel next to the aircraft does not end it; moving the map does.
  const { x, y } = await middle(page)
  await page.mouse.move(x + 150, y + 50)
  await page.mouse.wheel(0, 200)
  await expectInTheMiddle(page, true)
  await page.mouse.move(x + 150, y)
  await page.mouse.down()
  await page.mouse.move(x + 60, y + 40, { steps: 4 })
  await page.mouse.up()
  await expect(page.getByText('Following A01')).toHaveCount(0)
  await expectInTheMiddle(page, false)
})

test('following begins and ends by key, in each view of the day', async ({ page, program, fleet }) => {
  await sendOff(fleet)
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  // Facts of the selected aircraft are below the decision about another.
  await choose(page, 'select a01')
  await expect(facts(page)).toContainText('in the air to East, lands 06:41')
  await facts(page).getByRole('button', { name: 'Follow' }).click()
  await expect(facts(page).getByRole('heading', { name: 'Following A01' })).toBeVisible()
  await expectAccessible(page)

  // The next decision changes the selection, and not what is followed.
  await page.keyboard.press('a')
  await expect(panel(page).getByRole('heading', { name: /^A03/ })).toBeVisible()
  await expect(facts(page).getByRole('heading', { name: 'Following A01' })).toBeVisible()

  await page.keyboard.press('g')
  await page.keyboard.press('t')
  await expect(page.getByRole('application', { name: /Timeline of the fleet/ })).toBeVisible()
  await expect(facts(page)).toContainText('in the air to East')
  await expectAccessible(page)
  await fleet.report({ type: 'landed', aircraft: 'A01', time: '06:40:00' })
  await expect(facts(page)).toContainText('at East, ready')
  await page.keyboard.press('f')
  await expect(facts(page)).toHaveCount(0)
  await page.keyboard.press('f')
  await expect(page.getByRole('heading', { name: /^Following A0/ })).toBeVisible()
  await choose(page, 'stop following')
  await expect(page.getByRole('heading', { name: /^Following/ })).toHaveCount(0)
})

test('the timeline brings the row of the followed aircraft into view', async ({ page, program }) => {
  await new Fleet(program.url, '').ask('PUT', '/v1/networks/two-hundred', { toml: networkOfTwoHundred() })
  const fleet = await Fleet.onNewDay(program.url, { network: 'two-hundred', seed: 1, policy: 'greedy' })
  await open(page, program, fleet)
  const scrolled = () =>
    page.getByRole('application', { name: /Timeline of the fleet/ }).evaluate((one) => one.scrollTop)
  expect(await scrolled()).toBe(0)
  await choose(page, 'follow a150')
  await expect(page.getByRole('heading', { name: 'Following A150' })).toBeVisible()
  await expect.poll(scrolled).toBeGreaterThan(1000)
  await page.keyboard.press('g')
  await page.keyboard.press('t')
  await expect.poll(scrolled).toBeGreaterThan(1000)
})

test('with reduced motion the map keeps a followed aircraft near its middle', async ({
  page,
  program,
  fleet,
}) => {
  await page.emulateMedia({ reducedMotion: 'reduce' })
  await sendOff(fleet)
  await open(page, program, fleet)
  await expect(page.getByText(/^A map of/)).toContainText('At 06:14: 1 in the air')
  await choose(page, 'follow a01')
  await expect(page.getByRole('heading', { name: 'Following A01' })).toBeVisible()
  await zoomIn(page, 4)
  await fleet.report({ type: 'clock', time: '06:32:00' })
  await expect(page.getByText(/^A map of/)).toContainText('At 06:32')
  await expect(() => expectNearTheMiddle(page)).toPass({ timeout: 20_000 })
})
