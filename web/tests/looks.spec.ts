// The look of a day's views, on a disturbed day of New York that stands still.

import type { Page } from '@playwright/test'
import type { Fleet } from './support/fleet'
import { morning, standStill } from './support/morning'
import type { Program } from './support/program'
import { expectToLook, screens, useOneFont } from './support/screens'
import { expect, open, panel, test } from './support/test'

/** Content that differs in each run: durations, times, and generated ids. */
function passing(page: Page) {
  return [
    page.locator('.decision .bar'),
    page.locator('.taken'),
    page.locator('td .id'),
    page.locator('time'),
  ]
}

const views: Record<string, (page: Page, program: Program, fleet: Fleet) => Promise<void>> = {
  now: async (page, program, fleet) => {
    await open(page, program, fleet)
    await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
    await expect(page.locator('.figures')).toContainText('% expected')
  },
  timeline: async (page, program, fleet) => {
    const outlook = page.waitForResponse(/\/outlook/)
    await open(page, program, fleet, 'timeline')
    await outlook
  },
  'what-if': async (page, program, fleet) => {
    await open(page, program, fleet, 'what-if')
    await page.getByRole('combobox', { name: 'From' }).selectOption('JFK')
    await page.getByRole('textbox', { name: /Until/ }).fill('09:00')
    await page.getByRole('button', { name: 'Add the change' }).click()
    await page.getByRole('button', { name: 'Compare', exact: true }).click()
    await expect(page.getByText(/They first differ at/)).toBeVisible({ timeout: 30_000 })
  },
  log: async (page, program, fleet) => {
    await open(page, program, fleet, 'log')
    await expect(page.getByRole('cell', { name: /has departed/ }).first()).toBeVisible()
  },
  days: async (page, program) => {
    await page.goto(program.console)
    await expect(page.getByRole('link', { name: /new-york/ })).toBeVisible()
  },
}

test('the views of a day look like their screenshots', async ({ page, program }) => {
  test.setTimeout(300_000)
  const fleet = await morning(program)
  await standStill(page)
  await page.addInitScript(useOneFont)
  for (const [view, show] of Object.entries(views)) {
    for (const screen of ['desk', 'phone'] as const) {
      await page.setViewportSize(screens[screen])
      // A view starts afresh only after the page was left.
      await page.goto('about:blank')
      await show(page, program, fleet)
      await page.mouse.move(0, 0)
      await expectToLook(page, `${view}-${screen}`, passing(page))
    }
  }
})
