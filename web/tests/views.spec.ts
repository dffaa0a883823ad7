// Every view of the shell: reached by key, accessible, and within the width of a phone.

import type { Page } from '@playwright/test'
import { dollars } from '../src/model/money'
import { Fleet, smallNetwork } from './support/fleet'
import { expect, expectAccessible, expectAccessibleInBoth, open, panel, test, waiting } from './support/test'

const views = ['now', 'timeline', 'what-if', 'log', 'replay'] as const

for (const view of views) {
  test(`axe finds no serious problem in ${view}`, async ({ page, program, fleet }) => {
    await fleet.decide('A01')
    await open(page, program, fleet, view)
    await expect(page.locator('main')).not.toContainText('Loading')
    await expectAccessibleInBoth(page)
  })
}

test('axe finds no serious problem in the days, the palette and the help', async ({
  page,
  program,
  fleet,
}) => {
  await page.goto(program.console)
  await expect(page.getByRole('link', { name: /small-2/ })).toHaveAttribute('href', new RegExp(fleet.day))
  await expectAccessibleInBoth(page)
  for (const key of ['n', '?', 'Control+k']) {
    await page.keyboard.press(key)
    await expect(page.getByRole('dialog')).toBeVisible()
    await expectAccessibleInBoth(page)
    await page.keyboard.press('Escape')
    await expect(page.getByRole('dialog')).toBeHidden()
  }
})

test('views are reached by keys, and the palette runs its commands', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await page.keyboard.press('g')
  await page.keyboard.press('l')
  await expect(page.getByRole('heading', { level: 1, name: 'Log' })).toBeVisible()
  await page.keyboard.press('Control+k')
  await page.getByRole('combobox', { name: /Find a command/ }).fill('what')
  await page.keyboard.press('Enter')
  await expect(page.getByRole('heading', { level: 1, name: 'What if' })).toBeVisible()
})

test('an aircraft is found by its name', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await page.keyboard.press('Control+k')
  await expect(page.getByRole('option', { name: /A04/ })).toHaveCount(0)
  await page.getByRole('combobox', { name: /Find a command/ }).fill('a04')
  await page.keyboard.press('Enter')
  await expect(panel(page).getByRole('heading', { name: /^A04/ })).toBeVisible()
})

test('single keys can be switched off', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await page.keyboard.press('?')
  await page.getByRole('checkbox', { name: /Single keys/ }).uncheck()
  await page.keyboard.press('Escape')
  await page.keyboard.press('g')
  await page.keyboard.press('l')
  await page.waitForTimeout(300)
  expect(page.url()).toContain('/now')
})

test('the skip link moves to the content without leaving the day', async ({ page, program, fleet }) => {
  await open(page, program, fleet, 'log')
  await page.keyboard.press('Tab')
  await expect(page.getByRole('link', { name: 'Skip to the content' })).toBeFocused()
  await page.keyboard.press('Enter')
  await expect(page.getByRole('main')).toBeFocused()
  expect(page.url()).toContain(fleet.day)
})

test('a day is created in the console', async ({ page, program, fleet }) => {
  await page.goto(program.console)
  await expect(page.getByRole('link', { name: /small-2/ })).toBeVisible()
  await page.keyboard.press('n')
  await page.getByRole('combobox', { name: 'Network' }).selectOption('small')
  await page.getByRole('spinbutton', { name: /Seed/ }).fill('9')
  await page.getByRole('textbox', { name: /Name/ }).fill('a day of tests')
  await page.getByRole('button', { name: 'Create day' }).click()
  await expect(waiting(page)).toHaveCount(6)
  expect(page.url()).not.toContain(fleet.day)
})

test('the list of days shows their progress and waiting aircraft', async ({ page, program, fleet }) => {
  const archived = await Fleet.onSmallDay(program.url)
  await archived.ask('POST', `/v1/days/${archived.day}/archive`)
  await page.goto(program.console)
  const row = (day: string) => page.getByRole('row').filter({ has: page.locator(`a[href*="${day}"]`) })
  await expect(row(fleet.day)).toContainText('Running')
  await expect(row(fleet.day)).toContainText('06:00')
  await expect(row(fleet.day)).toContainText('6 aircraft')
  await expect(row(archived.day)).toContainText('Archived')
  await fleet.playUntil('07:00:00')
  const { totals } = await fleet.state()
  await expect(row(fleet.day)).toContainText(dollars(totals.profit_usd))
  await fleet.playToTheEnd()
  await expect(row(fleet.day)).toContainText('Over')
  await page.setViewportSize({ width: 390, height: 844 })
  await expect(row(fleet.day).getByText('Over')).toBeInViewport()
  const link = row(fleet.day).getByRole('link')
  const lines = await link.evaluate(
    (element) => element.clientHeight / parseFloat(getComputedStyle(element).lineHeight),
  )
  expect(lines).toBeLessThan(1.5)
  await expectAccessible(page)
})

test('an unknown address is reported', async ({ page, program, fleet }) => {
  await page.goto(`${program.console}/#/nowhere`)
  await expect(page.getByText('There is no page at this address. Showing “Days” instead.')).toBeVisible()
  await page.goto(`${program.console}/#/day/${fleet.day}/nowhere`)
  await expect(page.getByText('There is no page at this address. Showing “Now” instead.')).toBeVisible()
  await page.goto(`${program.console}/#/studies`)
  await expect(page.getByText('There is no page at this address')).toHaveCount(0)
})

test('a missing object in an address is explained, with a link to continue', async ({
  page,
  program,
  fleet,
}) => {
  await page.goto(`${program.console}/#/day/zzz/now`)
  await expect(page.getByText('There is no day “zzz” here.')).toBeVisible()
  await expect(page.getByText('V602')).toHaveCount(0)
  await page.getByRole('link', { name: 'All days' }).click()
  await expect(page.getByRole('link', { name: /small-2/ })).toHaveAttribute('href', new RegExp(fleet.day))

  await page.goto(`${program.console}/#/studies?study=zzz`)
  await expect(page.getByText('There is no study “zzz” here.')).toBeVisible()
  await page.goto(`${program.console}/#/replay?study=zzz`)
  await expect(page.getByText('There is no study “zzz” here.')).toBeVisible()
  await page.getByRole('link', { name: 'All studies' }).click()
  await expect(page.getByRole('heading', { level: 1, name: 'Studies' })).toBeVisible()
})

test('networks have an address, and the former one still works', async ({ page, program }) => {
  for (const address of ['networks', 'editor']) {
    await page.goto('about:blank')
    await page.goto(`${program.console}/#/${address}`)
    await expect(page.getByRole('heading', { level: 1, name: 'Networks' })).toBeVisible()
    await expect(page.getByRole('link', { name: 'Networks' })).toHaveAttribute('aria-current', 'page')
  }
})

test('the log contains the places of departures and landings', async ({ page, program, fleet }) => {
  await fleet.decide('A01', { to: 'East', reason: 'a test' })
  await fleet.report(
    { type: 'departed', aircraft: 'A01' },
    { type: 'landed', aircraft: 'A01', time: '06:50:00' },
  )
  await open(page, program, fleet, 'log?type=landed')
  await expect(page.getByRole('cell', { name: 'A01 has landed at East' })).toBeVisible()
  await open(page, program, fleet, 'log?vertiport=East')
  await expect(page.getByRole('cell', { name: 'A01 has departed for East' })).toBeVisible()
})

test('a what-if compares both continuations of the day and can be reported', async ({
  page,
  program,
  fleet,
}) => {
  await open(page, program, fleet, 'what-if')
  await page.getByRole('combobox', { name: 'From' }).selectOption('South')
  await page.getByRole('textbox', { name: /Until/ }).fill('08:00')
  await page.getByRole('button', { name: 'Add the change' }).click()
  await page.getByRole('button', { name: 'Compare', exact: true }).click()
  const profit = page.getByRole('row', { name: /^Profit/ })
  await expect(profit).toContainText('−\u2060$')
  await expect(page.getByText(/They first differ at 06:00:00: A0\d .*; what if: A0\d .*/)).toBeVisible()
  expect(await fleet.events()).toHaveLength(0)
  await page.getByRole('button', { name: 'Report it' }).click()
  await expect(page.getByText('1 event is reported to the day.')).toBeVisible()
  expect((await fleet.events())[0]?.event).toMatchObject({ type: 'closed', routes: { vertiport: 'South' } })
})

test('events can be reported by hand', async ({ page, program, fleet }) => {
  await fleet.decide('A01')
  await open(page, program, fleet)
  await page.keyboard.press('e')
  const dialog = page.getByRole('dialog', { name: 'Report an event' })
  await dialog.getByRole('combobox', { name: 'What happened' }).selectOption('closed')
  await dialog.getByRole('combobox', { name: 'From' }).selectOption('South')
  await dialog.getByRole('textbox', { name: /Until/ }).fill('noon')
  await dialog.getByRole('button', { name: 'Report', exact: true }).click()
  await expect(dialog.getByText('Enter the time as')).toBeVisible()
  await dialog.getByRole('textbox', { name: /Until/ }).fill('8:00')
  await dialog.getByRole('textbox', { name: /When/ }).fill('06:05')
  await dialog.getByRole('textbox', { name: /Reason/ }).fill('fog')
  await expectAccessible(page)
  await dialog.getByRole('button', { name: 'Report', exact: true }).click()
  await expect(page.getByText('All routes of South are closed until 08:00:00.')).toBeVisible()
  const { event } = (await fleet.events()).at(-1) ?? {}
  expect(event).toEqual({
    type: 'closed',
    routes: { vertiport: 'South' },
    time: '06:05:00',
    until: '08:00:00',
    reason: 'fog',
  })
})

test('a closure until further notice is reported, and its end is set once', async ({
  page,
  program,
  fleet,
}) => {
  await open(page, program, fleet)
  await page.keyboard.press('e')
  const dialog = page.getByRole('dialog', { name: 'Report an event' })
  const what = dialog.getByRole('combobox', { name: 'What happened' })
  await what.selectOption('delayed')
  await dialog.getByRole('textbox', { name: /Until/ }).fill('09:59')
  await what.selectOption('closed')
  const until = dialog.getByRole('textbox', { name: /Until/ })
  await expect(until).toHaveValue('07:00:00')
  await until.fill('')
  await dialog.getByRole('textbox', { name: /Reason/ }).fill('fog')
  await expect(until).toHaveValue('')
  await dialog.getByRole('button', { name: 'Report', exact: true }).click()
  await expect(dialog).toBeHidden()
  const { event } = (await fleet.events()).at(-1) ?? {}
  expect(event).toMatchObject({ type: 'closed', reason: 'fog' })
  expect(event).not.toHaveProperty('until')
  // Nothing of this report is left for the next.
  await page.keyboard.press('e')
  await expect(dialog.getByRole('textbox', { name: /Reason/ })).toHaveValue('')
  await expect(until).toHaveValue('07:00:00')
})

test('a far step of the clock is confirmed, and can be taken back in the log', async ({
  page,
  program,
  fleet,
}) => {
  await open(page, program, fleet)
  await page.keyboard.press('e')
  const dialog = page.getByRole('dialog', { name: 'Report an event' })
  await dialog.getByRole('combobox', { name: 'What happened' }).selectOption('clock')
  await dialog.getByRole('textbox', { name: /When/ }).fill('09:59')
  await dialog.getByRole('button', { name: 'Report', exact: true }).click()
  await expect(dialog.getByRole('alert').filter({ hasText: 'from 06:00:00 to 09:59:00' })).toBeVisible()
  expect(await fleet.events()).toHaveLength(0)
  await dialog.getByRole('button', { name: 'Report all the same' }).click()
  await expect(page.locator('header .clock')).toHaveText(/^09:59/)

  await open(page, program, fleet, 'log')
  await page.getByRole('row').filter({ hasText: 'The clock advanced' }).getByRole('button').first().click()
  await page.getByRole('button', { name: 'Take back this event…' }).click()
  await page.getByRole('textbox', { name: /Reason/ }).fill('typed wrong')
  await page.getByRole('button', { name: 'Take back', exact: true }).click()
  await expect(page.getByText('Event 1 was taken back').first()).toBeVisible()
  // The log marks the event, and the correction leads to it and back.
  const row = (number: number) =>
    page.getByRole('row').filter({ has: page.getByRole('cell', { name: String(number), exact: true }) })
  await expect(row(1)).toContainText(/taken back at \d\d:\d\d:\d\d UTC/)
  await expect(row(2)).not.toContainText(/taken back at/)
  await row(2).getByRole('button', { name: 'Show event 1' }).click()
  const details = page.getByRole('dialog', { name: 'Event 1' })
  await expect(details).toContainText(/This event was taken back at \d\d:\d\d:\d\d UTC/)
  await expectAccessible(page)
  await details.getByRole('button', { name: 'Show event 2' }).click()
  await expect(page.getByRole('dialog', { name: 'Event 2' })).toContainText('Event 1 was taken back')
  await page.keyboard.press('Escape')
  await expectAccessible(page)
  await expect(page.locator('header .clock')).toHaveText(/^06:0/)
  expect((await fleet.state()).now).toBe('06:00:00')
})

test('all waiting aircraft are decided at once, and an acknowledged alert is so for all', async ({
  page,
  context,
  program,
  fleet,
}) => {
  await fleet.report({ type: 'out_of_service', aircraft: 'A06', reason: 'bird strike' })
  await open(page, program, fleet)
  await page.getByRole('button', { name: 'Accept all 5' }).click()
  await expect(page.getByText('5 decisions accepted as advised.')).toBeVisible()
  await expect(waiting(page)).toHaveCount(0)
  const failed = (shown: Page) => shown.getByRole('listitem').filter({ hasText: 'A06 is out of service' })
  await page.keyboard.press('w')
  await failed(page).getByRole('button', { name: 'Acknowledge' }).click()
  await expect(failed(page).getByText('acknowledged')).toBeVisible()
  const other = await context.newPage()
  await open(other, program, fleet)
  await other.keyboard.press('w')
  await expect(failed(other).getByText('acknowledged')).toBeVisible()
})

test('an error of the service is shown with its code and remedy', async ({ page, program, fleet }) => {
  await open(page, program, fleet, 'what-if')
  await page.getByRole('combobox', { name: 'Change', exact: true }).selectOption('aircraft')
  await page.getByRole('spinbutton').fill('9')
  await page.getByRole('button', { name: 'Add the change' }).click()
  await page.getByRole('button', { name: 'Compare', exact: true }).click()
  await expect(page.getByRole('alert').getByText(/Error V113/)).toBeVisible()
})

test('a log of thousands of events renders few of them', async ({ page, program, fleet }) => {
  for (let page = 0; page < 5; page++) {
    await fleet.report(
      ...Array.from(
        { length: 400 },
        () => ({ type: 'booked', from: 'North', to: 'East', period: '07:00:00', passengers: 1 }) as const,
      ),
    )
  }
  await fleet.report({ type: 'closed', routes: { vertiport: 'South' }, reason: 'fog' })
  await open(page, program, fleet, 'log')
  await expect(page.getByText('2,001 events')).toBeVisible()
  expect(await page.getByRole('row').count()).toBeLessThan(60)
  const rows = page.locator('.rows')
  await rows.evaluate((element) => (element.scrollTop = 15_000))
  const read = page.getByRole('row').filter({ hasText: /^1495\b/ })
  await expect(read).toBeInViewport()
  const before = (await read.boundingBox())?.y ?? 0
  await fleet.report({ type: 'clock', time: '06:10:00' }, { type: 'clock', time: '06:11:00' })
  await expect(page.getByText('2,003 events')).toBeVisible()
  await expect.poll(async () => (await read.boundingBox())?.y).toBeCloseTo(before, 0)
  await page.getByRole('searchbox', { name: 'Search' }).fill('fog')
  await expect(page.getByText('1 of 2,003 events')).toBeVisible()
  expect(page.url()).toContain('text=fog')
})

test('no view is wider than a phone', async ({ page, program, fleet }) => {
  await page.setViewportSize({ width: 390, height: 844 })
  for (const view of views) {
    await open(page, program, fleet, view)
    await expect(page.locator('main')).not.toContainText('Loading')
    const wide = await page.evaluate(() => {
      const main = document.querySelector('main')
      return Math.max(document.documentElement.scrollWidth, main?.scrollWidth ?? 0)
    })
    expect(wide, view).toBeLessThanOrEqual(390)
  }
})

test('with reduced motion the clock changes once a second, and at events', async ({ page, program }) => {
  await page.emulateMedia({ reducedMotion: 'reduce' })
  void program.operate(smallNetwork, '--policy', 'prices', '--speed', '300')
  const fleet = await Fleet.onDayOfOthers(program.url)
  await open(page, program, fleet)
  const changes = () =>
    page.evaluate(
      () =>
        new Promise<number>((done) => {
          const clock = document.querySelector('header .clock')
          if (clock === null) throw new Error('there is no clock')
          let changes = 0
          const observer = new MutationObserver(() => (changes += 1))
          observer.observe(clock, { characterData: true, subtree: true, childList: true })
          setTimeout(() => done(changes), 2000)
        }),
    )
  await expect.poll(changes, { timeout: 40_000 }).toBeGreaterThan(1)
  const before = (await fleet.events()).length
  const seen = await changes()
  expect(seen).toBeLessThanOrEqual(3 + (await fleet.events()).length - before)
})
