// Comparisons of a day: a what-if with the day as it is, and the replay of a live day with a
// policy's plan.

import type { Page } from '@playwright/test'
import { fixture } from './support/pictures'
import { expect, expectAccessible, open, test } from './support/test'

/** Compares the day with and without a closure of South. */
async function closeSouth(page: Page): Promise<void> {
  await page.getByRole('combobox', { name: 'From' }).selectOption('South')
  await page.getByRole('textbox', { name: /Until/ }).fill('08:00')
  await page.getByRole('button', { name: 'Add the change' }).click()
  await page.getByRole('button', { name: 'Compare', exact: true }).click()
  await expect(page.getByText(/They first differ at/)).toBeVisible()
}

const sides = ['As it is', 'What if'] as const

test('both continuations of a day are visible at once, with the number of differences', async ({
  page,
  program,
  fleet,
}) => {
  await open(page, program, fleet, 'what-if')
  await closeSouth(page)
  for (const side of sides) {
    const timeline = page.getByRole('region', { name: side, exact: true })
    await expect(timeline.getByRole('application')).toBeInViewport({ ratio: 0.99 })
    await expect(timeline.getByText(/different: \d+ of \d+ flights and holds until 08:00/)).toBeVisible()
  }
  await expectAccessible(page)
})

test('the first difference is shown in both continuations, by button and by key', async ({
  page,
  program,
  fleet,
}) => {
  await open(page, program, fleet, 'what-if')
  await closeSouth(page)
  const message = await page.getByText(/They first differ at/).textContent()
  const [, aircraft = ''] = /: (A\d+) /.exec(message ?? '') ?? []
  for (const show of [
    () => page.getByRole('button', { name: 'Show the first' }).click(),
    () => page.keyboard.press('d'),
  ]) {
    await show()
    for (const side of sides) {
      const timeline = page.getByRole('region', { name: side, exact: true })
      await timeline.getByRole('button', { name: 'As a table' }).click()
      await expect(timeline.getByLabel('Aircraft', { exact: true })).toHaveValue(
        String(Number(aircraft.slice(1)) - 1),
      )
      const other = side === 'As it is' ? 'What if' : 'As it is'
      await expect(timeline.getByText(`differs from “${other}”`).first()).toBeVisible()
      await timeline.getByRole('button', { name: 'As a table' }).click()
    }
  }
})

test('a comparison without differences says so', async ({ page, program, fleet }) => {
  await open(page, program, fleet, 'what-if')
  await page.getByRole('button', { name: 'Compare', exact: true }).click()
  await expect(
    page.getByText('The day continues in the same way with and without the changes.'),
  ).toBeVisible()
  await expect(page.getByText(/different:/)).toHaveCount(0)
})

test.describe('the replay of a live day', () => {
  test.beforeEach(async ({ fleet }) => fleet.playUntil('07:00:00'))

  test('shows the plan of a policy, also from a link', async ({ page, program, fleet }) => {
    await open(page, program, fleet, 'replay')
    await page.getByLabel('Compare with').selectOption('greedy')
    await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(2)
    const planned = 'greedy, as planned in the morning'
    await expect(page.getByRole('definition').filter({ hasText: planned })).toBeVisible()
    await expect(page.getByText(/^The decisions of greedy if the day had gone as forecast/)).toBeVisible()
    await expect(
      page.getByText(
        /^By 07:\d\d:\d\d greedy, as planned in the morning, would have earned (\$[\d,]+ (more|less)|neither more nor less) than the actual day\.$/,
      ),
    ).toBeVisible()
    await expect(
      page.getByText('The day differed from the forecast, so this is not the effect of a single decision.'),
    ).toBeVisible()
    await expect(page.getByText(/With this decision alone/)).toHaveCount(0)
    await expect(page).toHaveURL(/with=greedy/)
    await expectAccessible(page)
    const address = page.url()
    await page.goto('about:blank')
    await page.goto(address)
    await expect(page.getByLabel('Compare with')).toHaveValue('greedy')
    await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(2)
    await page.getByLabel('Compare with').selectOption('')
    await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(1)
    await expect(page).not.toHaveURL(/with=/)
  })

  test('explains why a policy has no plan', async ({ page, program, fleet }) => {
    await page.route(/outlook\?.*policy=rolling/, (route) =>
      route.fulfill({
        status: 409,
        contentType: 'application/problem+json',
        body: JSON.stringify({
          code: 'V307',
          detail: 'it cannot play this day',
          hint: 'ask another',
          status: 409,
          title: '',
          type: '',
        }),
      }),
    )
    await open(page, program, fleet, 'replay')
    await page.getByLabel('Compare with').selectOption('rolling')
    await expect(page.getByText('Error V307')).toBeVisible()
    await expect(page.getByText('ask another')).toBeVisible()
    await expect(page.getByLabel('Compare with')).toHaveValue('')
    await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(1)
  })

  test('still offers plans after a trace was added, and returns from another day', async ({
    page,
    program,
    fleet,
  }) => {
    const trace = await (await fetch(`${program.url}/v1/days/${fleet.day}/trace.csv`)).text()
    await open(page, program, fleet, 'replay')
    const files = page.getByLabel('Choose files')
    await files.setInputFiles({ name: 'mine.csv', mimeType: 'text/csv', buffer: Buffer.from(trace) })
    const choice = page.getByLabel('Compare with')
    await expect(choice.getByRole('option', { name: 'mine, from a file' })).toBeAttached()
    await expect(page.getByRole('definition').filter({ hasText: /^mine$/ })).toBeVisible()
    await choice.selectOption({ label: 'greedy, as planned in the morning' })
    await expect(page.getByText(/^By 07:.*greedy, as planned in the morning, would have/)).toBeVisible()
    await page.getByLabel('Policy', { exact: true }).selectOption({ label: 'mine, from a file' })
    await expect(page.getByRole('definition').filter({ hasText: /^mine$/ })).toBeVisible()

    await files.setInputFiles([fixture('tiny-1.json'), fixture('tiny-1-greedy.csv')])
    await expect(page.getByText('From files: tiny-1')).toBeVisible()
    await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(1)
    await page.getByRole('button', { name: /^Back to small/ }).click()
    await expect(page.getByText('From files: tiny-1')).toHaveCount(0)
    await expect(page.getByRole('definition').filter({ hasText: 'Actual day' })).toBeVisible()
    await expect(choice).toHaveValue('')
    await expect(choice.getByRole('option', { name: 'mine, from a file' })).toBeAttached()
  })

  test('reports an unknown policy in a link', async ({ page, program, fleet }) => {
    await page.goto(`${program.console}/#/day/${fleet.day}/replay?with=zzz`)
    await expect(page.getByText('There is no policy “zzz” to compare with the day.')).toBeVisible()
    await expect(page.getByLabel('Compare with')).toHaveValue('')
  })

  test('has one clock, which shows the time of the replay', async ({ page, program, fleet }) => {
    await open(page, program, fleet, 'replay')
    await expect(page.getByRole('time')).toHaveText('06:00:00')
    await expect(page.locator('header .clock')).toHaveCount(0)
  })

  test('explains which files it needs, and which one is wrong', async ({ page, program, fleet }) => {
    await open(page, program, fleet, 'replay')
    const add = page.getByRole('button', { name: 'Add files' })
    await expect(add).toHaveAccessibleDescription(
      /one or more of its traces \(\.csv\).*vertifleet simulate day\.json/,
    )
    const hint = page.getByRole('tooltip')
    await expect(hint).toBeHidden()
    await add.focus()
    await expect(hint).toBeVisible()
    await expectAccessible(page)
    await page.keyboard.press('Escape')
    await expect(hint).toBeHidden()
    await page.getByLabel('Choose files').setInputFiles([fixture('tiny-1-greedy.csv')])
    await expect(page.getByRole('alert')).toContainText(/^tiny-1-greedy\.csv: Line \d+: /)
    await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(1)
  })
})

test('the buttons of a timeline can be clicked', async ({ page, program, fleet }) => {
  await open(page, program, fleet, 'timeline')
  for (const tools of await page.getByRole('group', { name: 'Tools of the timeline' }).all()) {
    for (const button of await tools.getByRole('button').all()) {
      const box = await button.boundingBox()
      expect(Math.min(box?.width ?? 0, box?.height ?? 0)).toBeGreaterThanOrEqual(24)
    }
  }
})
