// A dispatcher decides in the console: accepts, overrides, undoes.

import { dollars } from '../src/model/money'
import { disturbedNetwork, Fleet } from './support/fleet'
import { expect, open, panel, test, waiting } from './support/test'

test('accepting takes the decision of the policy', async ({ page, context, program, fleet }) => {
  await open(page, program, fleet)
  await expect(waiting(page)).toHaveCount(6)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.keyboard.press('a')
  await expect(page.getByText(/^A01 (flies to|holds at) /)).toBeVisible()
  await expect(waiting(page)).toHaveCount(5)
  const [decided] = await fleet.events()
  expect(decided?.event).toMatchObject({ type: 'decided', aircraft: 'A01', policy: 'prices' })

  // Without tokens the service cannot identify users. This console marks its own decisions only.
  await fleet.decide('A02')
  const lately = page.getByRole('region', { name: 'Recent decisions' }).getByRole('listitem')
  await expect(lately.filter({ hasText: 'A01' })).toContainText('you · prices')
  await expect(lately.filter({ hasText: 'A02' })).toContainText('as prices advised')

  // It still does after a reload, and can undo them; a console in another tab cannot.
  await page.reload()
  await expect(lately.filter({ hasText: 'A01' })).toContainText('you · prices')
  await expect(lately.filter({ hasText: 'A02' })).toContainText('as prices advised')
  const other = await context.newPage()
  await open(other, program, fleet)
  const there = other.getByRole('region', { name: 'Recent decisions' }).getByRole('listitem')
  await expect(there.filter({ hasText: 'A01' })).toContainText('as prices advised')
  await page.keyboard.press('u')
  await expect(page.getByText('The decision of A01 has been undone.')).toBeVisible()
})

test('advice that has only just appeared cannot be accepted yet, and its button is disabled', async ({
  page,
  program,
  fleet,
}) => {
  await page.addInitScript(() => {
    const seen: boolean[] = []
    Object.assign(window, { seen })
    new MutationObserver(() => {
      const button = document.querySelector<HTMLButtonElement>('.advice .first')
      if (button !== null && seen.at(-1) !== button.disabled) seen.push(button.disabled)
    }).observe(document, { childList: true, subtree: true, attributes: true })
  })
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  expect(await page.evaluate(() => (window as unknown as { seen: boolean[] }).seen)).toEqual([true, false])
})

test('the undo button disappears when the aircraft departs', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.keyboard.press('a')
  const toast = page.getByRole('status').filter({ hasText: /A01 (flies to|holds at) / })
  await expect(toast.getByRole('button', { name: 'Undo' })).toBeVisible()
  await fleet.report({ type: 'departed', aircraft: 'A01' })
  await expect(toast.getByRole('button', { name: 'Undo' })).toBeHidden()
  await expect(toast).toBeVisible()
})

test('a key that is pressed twice decides for one aircraft', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.keyboard.press('Enter')
  await page.keyboard.press('Enter')
  await page.keyboard.press('Enter')
  await expect(panel(page).getByRole('heading', { name: /^A02/ })).toBeVisible()
  expect(await fleet.events()).toHaveLength(1)
})

test('a whole disturbed day of vertifleet operate is dispatched by accepting', async ({ page, program }) => {
  test.setTimeout(240_000)
  let isOver = false
  const operator = program
    .operate(disturbedNetwork, '--seed', '2', '--policy', 'prices', '--by-hand')
    .finally(() => (isOver = true))
  const fleet = await Fleet.onDayOfOthers(program.url)
  await open(page, program, fleet)
  const accept = panel(page).getByRole('button', { name: 'Accept' })
  const newer = panel(page).getByRole('button', { name: /^Show/ })
  // The operator sets it when the day has ended.
  // eslint-disable-next-line @typescript-eslint/no-unnecessary-condition
  while (!isOver) {
    const before = await fleet.decisions()
    if ((await fleet.waiting()).length === 0) {
      await page.waitForTimeout(20)
      continue
    }
    // A key is ignored while advice is too new to have been read, so a user may have to press it
    // again. On a slow machine the second press may then be for the next aircraft. If the advice
    // changed between the press and the decision, the newer advice waits until the user asks for
    // it.
    await expect(async () => {
      if ((await fleet.decisions()) > before) return
      if (await newer.isVisible()) await page.keyboard.press('r')
      await expect(accept).toBeEnabled({ timeout: 700 })
      await page.keyboard.press('a')
      await expect.poll(() => fleet.decisions(), { timeout: 700 }).toBeGreaterThan(before)
    }).toPass({ timeout: 60_000 })
  }
  expect(await operator).toBe('')
  const { totals } = await fleet.state()
  expect(totals.passengers).toBeGreaterThan(0)
  const events = (await fleet.events()).map((one) => one.event)
  const kinds = new Set(events.map((one) => one.type))
  for (const kind of ['delayed', 'closed', 'reopened', 'out_of_service'] as const)
    expect(kinds).toContain(kind)
  const decided = events.filter((one) => one.type === 'decided')
  expect(decided).toHaveLength(totals.decisions)
  expect(decided.every((one) => one.policy === 'prices')).toBe(true)
  await expect(page.locator('.figures')).toContainText(dollars(totals.profit_usd))
})

test('an override needs a reason, which the log contains', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  const advised = (await panel(page).locator('.choice').innerText()).split(' ').at(-1)
  await page.keyboard.press('o')
  await expect(panel(page).getByRole('combobox', { name: 'Destination' })).toBeFocused()
  await panel(page).getByRole('button', { name: 'Override', exact: true }).click()
  await expect(panel(page).getByText('Enter a reason')).toBeVisible()
  expect(await fleet.events()).toHaveLength(0)
  await panel(page).getByRole('textbox', { name: 'Reason' }).fill('the crew lives there')
  const to = await panel(page).getByRole('combobox', { name: 'Destination' }).inputValue()
  expect(to).not.toBe(advised)
  await page.keyboard.press('Enter')
  await expect(page.getByText(new RegExp(`^A01 (flies to|holds at) ${to}`))).toBeVisible()
  const [decided] = await fleet.events()
  expect(decided?.event).toMatchObject({
    aircraft: 'A01',
    to,
    instead_of: advised,
    reason: 'the crew lives there',
  })
  await page.keyboard.press('Escape')
  await page.goto(`${program.console}/#/day/${fleet.day}/log?aircraft=A01`)
  await expect(page.getByRole('cell', { name: /“the crew lives there”/ })).toBeVisible()
})

test('a decision can be undone until the aircraft departs', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.keyboard.press('a')
  await expect(panel(page).getByRole('heading', { name: /^A02/ })).toBeVisible()
  await page.keyboard.press('u')
  await expect(page.getByText('The decision of A01 has been undone.')).toBeVisible()
  expect((await fleet.events()).map((one) => one.event.type)).toEqual(['decided', 'undone'])

  await expect(page.getByRole('region', { name: 'Needs a decision' }).locator('.badge')).toHaveText('6')
  // The panel returns to the aircraft.
  await expect(panel(page).getByRole('heading', { name: /^A01/ })).toBeVisible()
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.keyboard.press('a')
  const lately = page
    .getByRole('region', { name: 'Recent decisions' })
    .getByRole('listitem')
    .filter({ hasText: 'A01' })
  await expect(lately.getByRole('button', { name: 'Undo' })).toBeVisible()
  await fleet.report({ type: 'departed', aircraft: 'A01' })
  await expect(lately.getByRole('button', { name: 'Undo' })).toBeHidden()
})

test('impossible choices are shown with their rules', async ({ page, program, fleet }) => {
  await fleet.report({ type: 'closed', routes: { vertiport: 'East' } })
  await open(page, program, fleet)
  const impossible = panel(page).getByRole('listitem').filter({ hasText: 'East' })
  await expect(impossible).toContainText('The route to East is closed.')
})

test('nothing moves under the pointer', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  const choice = panel(page).locator('.choice')
  const advised = await choice.innerText()
  const to = advised.split(' ').at(-1) ?? ''
  const accept = panel(page).getByRole('button', { name: 'Accept' })
  await accept.hover()
  const before = await accept.boundingBox()
  await fleet.report({ type: 'closed', routes: { vertiport: to } })
  await expect(panel(page).getByText(/The day has advanced/)).toBeVisible()
  expect(await choice.innerText()).toBe(advised)
  expect(await accept.boundingBox()).toEqual(before)
  await expect(accept).toBeDisabled()
  await page.keyboard.press('r')
  await expect(choice).not.toHaveText(advised)
  await expect(panel(page).getByText(/The day has advanced/)).toBeHidden()
})
