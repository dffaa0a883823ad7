// No key acts on what an open form or list of the view Now covers. The keys come from the console's
// own list of keys, and each is pressed on each control of each form. dialogs.spec.ts has the other
// views.

import type { Page } from '@playwright/test'
import type { Fleet } from './support/fleet'
import { allKeysOf } from './support/keys'
import { expect, open, panel, test } from './support/test'

interface Form {
  name: string
  /** The key that opens it. */
  opens: string
  /** The control that has the focus first. */
  first: (page: Page) => ReturnType<Page['getByRole']>
  isOpen: (page: Page) => ReturnType<Page['getByRole']>
}

const forms: Form[] = [
  {
    name: 'the form to override',
    opens: 'o',
    first: (page) => panel(page).getByRole('combobox', { name: 'Destination' }),
    isOpen: (page) => panel(page).getByRole('textbox', { name: 'Reason' }),
  },
  {
    name: 'the list of alerts',
    opens: 'w',
    first: (page) =>
      page.getByRole('region', { name: 'Alerts' }).getByRole('listitem').first().locator('.what'),
    isOpen: (page) => page.getByRole('region', { name: 'Alerts' }),
  },
  {
    name: 'the report form',
    opens: 'e',
    first: (page) => page.getByRole('combobox', { name: 'What happened' }),
    isOpen: (page) => page.getByRole('dialog', { name: 'Report an event' }),
  },
  {
    name: 'the list of keys',
    opens: '?',
    first: (page) => page.getByRole('dialog', { name: 'Keys' }).getByRole('button', { name: 'Close' }),
    isOpen: (page) => page.getByRole('dialog', { name: 'Keys' }),
  },
  {
    name: 'the palette',
    opens: 'Control+k',
    first: (page) => page.getByRole('combobox', { name: /Find a command/ }),
    isOpen: (page) => page.getByRole('dialog', { name: 'Find a command' }),
  },
]

/** The single keys and sequences of the view; Enter presses the focused button. */
async function keysOf(page: Page): Promise<string[][]> {
  const keys = await allKeysOf(page)
  return keys.filter((one) => !one.includes('Enter') && !one.some((key) => key.includes(' ')))
}

/** A day with alerts, on which six aircraft wait. */
async function withAlerts(fleet: Fleet): Promise<void> {
  await fleet.report(
    { type: 'closed', routes: { from: 'North', to: 'East' }, reason: 'fog' },
    { type: 'out_of_service', aircraft: 'A06', reason: 'bird strike' },
  )
}

for (const form of forms) {
  test(`no key acts on what ${form.name} covers`, async ({ page, program, fleet }) => {
    await withAlerts(fleet)
    await open(page, program, fleet)
    await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
    const keys = await keysOf(page)
    for (const key of ['a', 'o', 'r', 'e', 'u', 'j', 'k', 'w', 'f', '?'])
      expect(keys, 'the list has all keys of the view').toContainEqual([key])
    const sent: string[] = []
    page.on('request', (request) => {
      if (request.method() !== 'GET') sent.push(`${request.method()} ${request.url()}`)
    })
    const waits = panel(page).getByRole('heading', { level: 2 })
    const [events, heading, url] = [(await fleet.events()).length, await waits.innerText(), page.url()]

    await page.keyboard.press(form.opens)
    await expect(form.first(page)).toBeFocused()
    const controls = form
      .isOpen(page)
      .locator('xpath=ancestor-or-self::*[self::form or self::section or self::dialog][1]')
    const all = await controls.locator('button, select, input').all()
    expect(all.length).toBeGreaterThan(0)
    for (const control of all) {
      await control.focus()
      for (const sequence of keys) for (const key of sequence) await page.keyboard.press(key)
      await expect(form.isOpen(page)).toBeVisible()
    }
    // Nor does a key while nothing has the focus.
    await page.evaluate(() => (document.activeElement as HTMLElement).blur())
    for (const sequence of keys) for (const key of sequence) await page.keyboard.press(key)
    await expect(form.isOpen(page)).toBeVisible()
    await expect(page.locator('dialog[open]')).toHaveCount(
      await form.isOpen(page).and(page.getByRole('dialog')).count(),
    )

    expect(sent).toEqual([])
    expect((await fleet.events()).length).toBe(events)
    expect(await waits.innerText()).toBe(heading)
    expect(page.url()).toBe(url)
    await page.keyboard.press('Escape')
    await expect(form.isOpen(page)).toBeHidden()
  })

  test(`${form.name} takes the focus and gives it back`, async ({ page, program, fleet }) => {
    await withAlerts(fleet)
    await open(page, program, fleet)
    await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
    const before = panel(page).getByRole('table').getByRole('button').last()
    for (const choosing of [false, true]) {
      // A choice that is highlighted already changes nothing about the first focus.
      if (choosing) await before.click()
      await before.focus()
      await page.keyboard.press(form.opens)
      await expect(form.first(page)).toBeFocused()
      await page.keyboard.press('Escape')
      await expect(form.isOpen(page)).toBeHidden()
      await expect(before).toBeFocused()
    }
  })
}

test('a reason that is typed after Tab decides nothing else', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await panel(page).getByRole('table').getByRole('button').last().click()
  await page.keyboard.press('o')
  await page.keyboard.press('Tab')
  await page.keyboard.type('avoid V4')
  await expect(panel(page).getByRole('textbox', { name: 'Reason' })).toHaveValue('avoid V4')
  await page.keyboard.press('Tab')
  await page.keyboard.type('avoid')
  expect(await fleet.events()).toHaveLength(0)
  // The palette does not offer what the form covers.
  await page.keyboard.press('Control+k')
  await page.getByRole('combobox', { name: /Find a command/ }).fill('Accept')
  await expect(page.getByText('No matches.')).toBeVisible()
})

test('the list of alerts closes when the focus leaves it', async ({ page, program, fleet }) => {
  await withAlerts(fleet)
  await open(page, program, fleet)
  await page.keyboard.press('w')
  const alerts = page.getByRole('region', { name: 'Alerts' })
  await alerts.getByRole('button').last().focus()
  await page.keyboard.press('Tab')
  await expect(alerts).toBeHidden()
})

test('a key that is held down decides for one aircraft', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.keyboard.down('a')
  await expect(panel(page).getByRole('heading', { name: /^A02/ })).toBeVisible()
  for (let repeat = 0; repeat < 20; repeat++) {
    await page.keyboard.down('a')
    await page.waitForTimeout(50)
  }
  expect(await fleet.events()).toHaveLength(1)
})
