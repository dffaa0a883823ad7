// A day of 200 aircraft, reported by vertifleet operate: all of it is shown, and decisions are
// taken as on a small day.

import { Fleet } from './support/fleet'
import { networkOfTwoHundred } from './support/pictures'
import { expect, open, panel, test, waiting } from './support/test'

test('200 aircraft are shown and decided', async ({ page, program }) => {
  test.slow()
  const network = networkOfTwoHundred()
  void program.operate(network, '--policy', 'greedy', '--speed', '60', '--by-hand')
  const fleet = await Fleet.onDayOfOthers(program.url)
  await expect.poll(async () => (await fleet.waiting()).length).toBe(200)
  await open(page, program, fleet)
  await expect(waiting(page)).toHaveCount(200)
  const map = page.getByRole('region', { name: 'Map' })
  await expect(map.getByText(/^A map of 60 vertiports and 200 aircraft/).first()).toBeAttached()
  for (const aircraft of ['A001', 'A002', 'A003']) {
    const heading = panel(page).getByRole('heading', { name: new RegExp(`^${aircraft}`) })
    await expect(heading).toBeVisible()
    // A key is ignored while newer advice arrives, as on a busy machine.
    await expect(async () => {
      await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
      if (await heading.isVisible()) await page.keyboard.press('a')
      const taken = page.getByText(new RegExp(`^${aircraft} (flies to|holds at) `))
      await expect(taken).toBeVisible({ timeout: 4000 })
    }).toPass({ timeout: 30_000 })
  }
  for (const aircraft of await fleet.waiting()) await fleet.decide(aircraft)
  await expect(map.getByText(/At 06:\d\d: 1\d\d in the air/).first()).toBeAttached({ timeout: 30_000 })
  await page.keyboard.press('g')
  await page.keyboard.press('t')
  // The view before has a timeline of the same name.
  await expect(page.getByRole('heading', { level: 1, name: 'Timeline' })).toBeAttached()
  await page.getByRole('application', { name: /Timeline of the fleet/ }).focus()
  await page.keyboard.press('ArrowDown')
  await expect(page.locator('[aria-live=polite]').filter({ hasText: /^A\d{3} / })).toBeAttached()
})
