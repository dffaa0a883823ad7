// No key acts on what a dialog covers, in the views other than Now, which keys.spec.ts tests. The
// keys come from the console's own list of keys. Each is pressed on each control of each dialog.

import type { Locator, Page } from '@playwright/test'
import type { Fleet } from './support/fleet'
import { allKeysOf } from './support/keys'
import { smallNetwork } from './support/fleet'
import type { Program } from './support/program'
import { expect, open, test } from './support/test'

interface View {
  show: (page: Page, program: Program, fleet: Fleet) => Promise<void>
  /** The control that has the focus before a dialog opens. */
  before: (page: Page) => Locator
  /** A key of the view, which shows that the list of keys is that of the view. */
  key: string
}

type Name = 'timeline' | 'what-if' | 'log' | 'replay' | 'days' | 'studies' | 'networks'

const views: Record<Name, View> = {
  timeline: {
    show: (page, program, fleet) => open(page, program, fleet, 'timeline'),
    before: (page) => page.getByRole('button', { name: 'As a table' }).first(),
    key: 'f',
  },
  'what-if': {
    show: (page, program, fleet) => open(page, program, fleet, 'what-if'),
    before: (page) => page.getByRole('button', { name: 'Compare', exact: true }),
    key: 'c',
  },
  log: {
    show: (page, program, fleet) => open(page, program, fleet, 'log'),
    before: (page) => page.getByRole('row').nth(1).getByRole('button').first(),
    key: '/',
  },
  replay: {
    show: (page, program, fleet) => open(page, program, fleet, 'replay'),
    before: (page) => page.getByRole('button', { name: 'Play', exact: true }),
    key: ']',
  },
  days: {
    show: async (page, program) => {
      await page.goto(`${program.console}/#/days`)
      await expect(page.getByRole('link', { name: /small-2/ })).toBeVisible()
    },
    before: (page) => page.getByRole('button', { name: 'New day' }),
    key: 'n',
  },
  studies: {
    show: async (page, program) => {
      await page.goto(`${program.console}/#/studies`)
      await expect(page.getByRole('heading', { level: 1, name: 'Studies' })).toBeVisible()
    },
    before: (page) => page.getByRole('button', { name: 'New study' }).first(),
    key: 'n',
  },
  networks: {
    show: async (page, program) => {
      await page.goto(`${program.console}/#/networks`)
      await page.getByRole('button', { name: /^paper(?!-)/ }).click()
      const checked = page.waitForResponse(/networks\/validate/)
      await page.getByLabel('Stands of V1').fill('7')
      await checked
      await expect(page.getByText(/^No errors:/)).toBeVisible()
      // A key that is typed into a field is no command.
      await page.getByRole('button', { name: 'Another network' }).focus()
    },
    before: (page) => page.getByRole('button', { name: 'Another network' }),
    key: 'p',
  },
}

interface Shown {
  name: string
  view: Name
  /** Opens the dialog by keys alone, since a click would move the focus. */
  open: (page: Page) => Promise<void>
}

const press =
  (...keys: string[]) =>
  async (page: Page) => {
    for (const key of keys) await page.keyboard.press(key)
  }

const dialogs: Shown[] = [
  ...(Object.keys(views) as Name[]).flatMap((view) => [
    { name: 'Find a command', view, open: press('Control+k') },
    { name: 'Keys', view, open: press('?') },
  ]),
  { name: 'Event 2', view: 'log', open: press('Enter') },
  {
    name: 'Event 2',
    view: 'log',
    open: async (page) => {
      await page.keyboard.press('Enter')
      await page.getByRole('button', { name: 'Take back this event…' }).press('Enter')
      await expect(page.getByRole('textbox', { name: /Reason/ })).toBeFocused()
    },
  },
  { name: 'New day', view: 'days', open: press('n') },
  { name: 'New study', view: 'studies', open: press('n') },
  { name: 'Save under a name', view: 'networks', open: press('Control+s') },
  { name: 'Open a network', view: 'networks', open: press('o') },
]

/** What the list shows, as keys to press: `Ctrl K` is `Control+k`. */
function asPressed(keys: string[][]): string[][] {
  return (
    keys
      .map((sequence) =>
        sequence.map((key) => key.replace(/^Ctrl (.+)$/, (_, one: string) => `Control+${one.toLowerCase()}`)),
      )
      // These press the focused control of the dialog.
      .filter((sequence) => !sequence.some((key) => /Enter|Space/i.test(key)))
  )
}

function shown(page: Page, name: string): Locator {
  return page.getByRole('dialog', { name, exact: true })
}

async function pressAll(page: Page, keys: string[][]): Promise<void> {
  for (const sequence of keys) for (const key of sequence) await page.keyboard.press(key)
}

/** The requests from now on that could change anything; checking a network changes nothing. */
function requestsOf(page: Page): string[] {
  const sent: string[] = []
  page.on('request', (request) => {
    const isReading = request.method() === 'GET' || request.url().endsWith('/networks/validate')
    if (!isReading) sent.push(`${request.method()} ${request.url()}`)
  })
  return sent
}

/** Everything that a user can change in a view: its text and its fields. */
async function contentOf(page: Page): Promise<string> {
  const main = page.locator('main')
  const fields = await main
    .locator('input, select, textarea')
    .evaluateAll((all) => all.map((one) => (one as HTMLInputElement).value))
  return [await main.innerText(), ...fields].join('\n')
}

for (const [index, { name, view, open: opens }] of dialogs.entries()) {
  test(`no key acts on ${view} under its dialog “${name}” (${index})`, async ({ page, program, fleet }) => {
    await fleet.decide('A01', { to: 'East', reason: 'a test' })
    await fleet.report({ type: 'departed', aircraft: 'A01', time: '06:00:00' })
    const { show, before, key } = views[view]
    await show(page, program, fleet)
    const list = await allKeysOf(page)
    expect(list, 'the list has the keys of the view').toContainEqual([key])
    const keys = asPressed(list)
    const sent = requestsOf(page)
    await before(page).focus()
    const [events, url, content] = [(await fleet.events()).length, page.url(), await contentOf(page)]

    await opens(page)
    const dialog = shown(page, name)
    await expect(dialog).toBeVisible()
    const all = await dialog.locator('button:enabled, select:enabled, input:enabled').all()
    expect(all.length).toBeGreaterThan(0)
    for (const control of all) {
      // Keys that are typed into the palette change its list, so a control may be gone.
      if ((await control.count()) === 0) continue
      await control.focus()
      await pressAll(page, keys)
      await expect(dialog).toBeVisible()
    }
    await page.evaluate(() => (document.activeElement as HTMLElement).blur())
    await pressAll(page, keys)
    await expect(dialog).toBeVisible()
    await expect(page.locator('dialog[open]')).toHaveCount(1)

    await page.keyboard.press('Escape')
    await expect(dialog).toBeHidden()
    await expect(before(page)).toBeFocused()
    expect(sent).toEqual([])
    expect((await fleet.events()).length).toBe(events)
    expect(page.url()).toBe(url)
    expect(await contentOf(page)).toBe(content)

    // At a second Escape the browser closes a dialog without asking; it can be opened again.
    for (let time = 0; time < 2; time++) {
      await opens(page)
      await expect(dialog).toBeVisible()
      await press('Escape', 'Escape')(page)
      await expect(dialog).toBeHidden()
    }
  })
}

test('a dialog opens again at a key that comes right after Escape', async ({ page, program, fleet }) => {
  await open(page, program, fleet, 'log')
  for (const [key, name] of [
    ['Control+k', 'Find a command'],
    ['?', 'Keys'],
  ] as const) {
    await page.keyboard.press(key)
    await expect(shown(page, name)).toBeVisible()
    for (let time = 0; time < 20; time++) {
      // Both are on their way before the browser reports that the dialog has closed.
      await Promise.all([page.keyboard.press('Escape'), page.keyboard.press(key)])
      await expect(shown(page, name)).toBeVisible()
    }
    await page.keyboard.press('Escape')
    await expect(shown(page, name)).toBeHidden()
  }
})

test('keys that are typed into the form of a what-if compare nothing', async ({ page, program, fleet }) => {
  await views['what-if'].show(page, program, fleet)
  const keys = asPressed(await allKeysOf(page)).filter((one) => !one.includes('Control+k'))
  const sent = requestsOf(page)
  const fields = page.locator('main').locator('input, select')
  for (let at = 0; at < (await fields.count()); at++) {
    await fields.nth(at).focus()
    await pressAll(page, keys)
  }
  expect(sent).toEqual([])
  await expect(page.locator('dialog[open]')).toHaveCount(0)
  expect(page.url()).toContain('/what-if')
})

for (const view of ['now', 'log'] as const) {
  test(`no key acts on ${view} while a token is asked for, and Escape does not close that`, async ({
    page,
    program,
    fleet,
  }) => {
    await open(page, program, fleet, view)
    const keys = asPressed(await allKeysOf(page))
    const url = page.url()
    const sent = requestsOf(page)
    program.token('dispatch')
    const dialog = shown(page, 'Sign in')
    await expect(dialog).toBeVisible()
    for (const control of await dialog.locator('button, input').all()) {
      await control.focus()
      await pressAll(page, keys)
    }
    for (let time = 0; time < 3; time++) await page.keyboard.press('Escape')
    await expect(dialog).toBeVisible()
    await page.evaluate(() => (document.activeElement as HTMLElement).blur())
    await pressAll(page, keys)
    await expect(page.locator('dialog[open]')).toHaveCount(1)
    expect(sent).toEqual([])
    expect(page.url()).toBe(url)
  })
}

test('no key acts on the editor while it asks whether to discard changes', async ({
  page,
  program,
  fleet,
}) => {
  await fleet.ask('PUT', '/v1/networks/other', { toml: smallNetwork.replace('"small"', '"other"') })
  await views.networks.show(page, program, fleet)
  const keys = asPressed(await allKeysOf(page))
  await page.keyboard.press('o')
  await shown(page, 'Open a network')
    .getByRole('button', { name: /^other/ })
    .click()
  const dialog = page.getByRole('dialog').filter({ hasText: 'Discard and open' })
  await expect(dialog).toBeVisible()
  await pressAll(page, keys)
  await expect(dialog).toBeVisible()
  await page.keyboard.press('Escape')
  await page.keyboard.press('Escape')
  await expect(page.getByRole('dialog')).toHaveCount(0)
  await expect(page.getByLabel('Stands of V1')).toHaveValue('7')
})
