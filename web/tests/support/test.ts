// The common parts of the console's tests: the program, a console on a day, and the check that the
// page has no errors.

import AxeBuilder from '@axe-core/playwright'
import { expect, test as base, type Page } from '@playwright/test'
import { Fleet } from './fleet'
import { Program } from './program'

interface Fixtures {
  program: Program
  fleet: Fleet
  /** Errors in the page: of scripts, and violations of the content security policy. */
  pageErrors: string[]
}

export const test = base.extend<Fixtures>({
  // eslint-disable-next-line no-empty-pattern -- Playwright requires a pattern.
  program: async ({}, use) => {
    const program = await Program.start()
    await use(program)
    await program.stop()
  },

  fleet: async ({ program }, use) => {
    await use(await Fleet.onSmallDay(program.url))
  },

  pageErrors: [
    async ({ context }, use) => {
      const pageErrors: string[] = []
      context.on('weberror', (error) => pageErrors.push(error.error().message))
      context.on('console', (message) => {
        if (/content security policy/i.test(message.text())) pageErrors.push(message.text())
      })
      await use(pageErrors)
      expect(pageErrors).toEqual([])
    },
    { auto: true },
  ],
})

export { expect }

/**
 * Opens a view of the fleet's day, and waits until it is loaded, because a view that is still
 * loading ignores keys.
 */
export async function open(page: Page, program: Program, fleet: Fleet, view = 'now'): Promise<void> {
  await page.goto(`${program.console}/#/day/${fleet.day}/${view}`)
  await expect(page.getByText('Live', { exact: true })).toBeVisible()
  await expect(page.getByRole('heading', { level: 1 })).toBeAttached()
}

/** The panel for decisions. */
export function panel(page: Page) {
  return page.getByRole('region', { name: 'Decision', exact: true })
}

/** The aircraft that wait for a decision, as buttons. */
export function waiting(page: Page) {
  return page.getByRole('region', { name: 'Needs a decision' }).getByRole('listitem').getByRole('button')
}

/** Checks with axe in the light and the dark theme, which differ only in contrast. */
export async function expectAccessibleInBoth(page: Page): Promise<void> {
  await page.emulateMedia({ colorScheme: 'light' })
  await expectAccessible(page)
  await page.emulateMedia({ colorScheme: 'dark' })
  await expectNothingSerious(new AxeBuilder({ page }).withRules('color-contrast'))
}

/** Checks that axe finds no serious problem. */
export async function expectAccessible(page: Page): Promise<void> {
  await expectNothingSerious(new AxeBuilder({ page }))
}

async function expectNothingSerious(axe: AxeBuilder): Promise<void> {
  const { violations } = await axe.analyze()
  const serious = violations.filter(({ impact }) => impact === 'serious' || impact === 'critical')
  const found = serious.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' | ')}`)
  expect(found).toEqual([])
}
