// The network editor against the real program: how forms, map and text affect each other, the
// service's findings, and the profit of a day.

import type { Page } from '@playwright/test'
import type { NetworkInfo } from '../src/api/types'
import { smallNetwork } from './support/fleet'
import { expectToLook, screens } from './support/screens'
import { expect, expectAccessible, expectAccessibleInBoth, test } from './support/test'

async function openNetwork(page: Page, console: string, name: string | RegExp): Promise<void> {
  await page.goto(`${console}/#/networks`)
  await page.getByRole('button', { name }).click()
  await expect(page.getByText(/^No errors:/)).toBeVisible()
}

function text(page: Page) {
  return page.getByRole('textbox', { name: 'Text of the network file' })
}

async function read(url: string, network: string): Promise<NetworkInfo> {
  return (await (await fetch(`${url}/v1/networks/${network}`)).json()) as NetworkInfo
}

test('a vertiport is added, corrected, saved and played', async ({ page, program }) => {
  await openNetwork(page, program.console, /plane of miles/)
  await page.getByRole('button', { name: 'Add a vertiport' }).click()
  const map = await page.getByRole('region', { name: 'Map of the vertiports' }).boundingBox()
  await page.mouse.click((map?.x ?? 0) + 300, (map?.y ?? 0) + 250)
  await expect(page.getByRole('button', { name: /^V1, 4 stands/ })).toBeFocused()
  await expect(page.getByText('No errors: 4 vertiports, 8 aircraft, 600 passengers a day')).toBeVisible()

  await page.getByLabel('Stands of V1').fill('0')
  await expect(page.getByText('1 error')).toBeVisible()
  await expect(page.getByText('V104')).toBeVisible()
  await expect(page.getByRole('button', { name: 'Save', exact: true })).toBeDisabled()
  await page.getByRole('tab', { name: 'Tariffs' }).click()
  await page.getByRole('button', { name: /^Show/ }).click()
  const stands = page.getByLabel('Stands of V1')
  await expect(stands).toBeFocused()
  await expect(stands).toHaveAccessibleDescription(/stands must be at least 1/)
  await stands.fill('3')
  await expect(page.getByText(/^No errors:/)).toBeVisible()

  await page.getByRole('button', { name: 'Save', exact: true }).click()
  await expect(page.getByText('region is saved.')).toBeVisible()
  const saved = await read(program.url, 'region')
  expect(saved.vertiports.map(({ id, stands }) => `${id} ${stands}`)).toContain('V1 3')
  expect(saved.toml).toContain('# A network of three vertiports in a plane of miles.')

  await page.getByRole('button', { name: 'What would a day earn?' }).click()
  const earn = page.getByRole('region', { name: 'What would a day earn?' })
  await earn.getByRole('spinbutton', { name: 'Days' }).fill('3')
  await earn.getByRole('combobox', { name: 'Policy' }).selectOption('greedy')
  await earn.getByRole('button', { name: 'Play', exact: true }).click()
  await expect(earn.getByText(/95 %, 3 days/)).toBeVisible()
  await page.getByLabel('Stands of V1').fill('9')
  await expect(earn.getByText('The network has changed since.')).toBeVisible()
  await expect(page.getByText(/^No errors:/)).toBeVisible()
  await earn.getByRole('button', { name: 'Play again' }).click()
  await expect(earn.getByText('Difference from the saved region')).toBeVisible()
  await expect(earn.getByText(/^± \$[\d,]+ \(95 %, same policy, 3 days with the same seeds\)/)).toBeVisible()
  await earn.getByRole('link', { name: 'All figures' }).click()
  await expect(page.getByText(/greedy earns/)).toBeVisible()
  await page.goBack()
  await expect(page.getByLabel('Stands of V1')).toHaveValue('9')
})

test('a new network is compared with its previous version, and an unchanged one with nothing', async ({
  page,
  program,
}) => {
  await openNetwork(page, program.console, /plane of miles/)
  await page.getByRole('button', { name: 'What would a day earn?' }).click()
  const earn = page.getByRole('region', { name: 'What would a day earn?' })
  await earn.getByRole('spinbutton', { name: 'Days' }).fill('2')
  await earn.getByRole('combobox', { name: 'Policy' }).selectOption('greedy')
  await earn.getByRole('button', { name: 'Play', exact: true }).click()
  await expect(earn.getByText(/95 %, 2 days/)).toBeVisible()
  await expect(earn.getByText(/Difference from/)).toHaveCount(0)
  await page.getByLabel('Stands of East').fill('9')
  await expect(page.getByText(/^No errors:/)).toBeVisible()
  await earn.getByRole('button', { name: 'Play again' }).click()
  await expect(earn.getByText('Difference from the version played before')).toBeVisible()
  await page.getByRole('button', { name: 'Save', exact: true }).click()
  await expect(page.getByText('region is saved.')).toBeVisible()
  await expect(earn.getByText('Difference from the version played before')).toBeVisible()
})

test('a field without its number shows an error, and the file keeps the former one', async ({
  page,
  program,
}) => {
  await openNetwork(page, program.console, /paper(?!-)/)
  const stands = page.getByLabel('Stands of V1')
  await stands.fill('')
  await expect(stands).toHaveAccessibleDescription('Enter a number. The file keeps 6 until then.')
  await expect(page.getByRole('alert')).toBeVisible()
  await expectAccessible(page)
  await page.keyboard.press('Tab')
  await expect(stands).toHaveValue('6')
  await expect(page.getByRole('alert')).toHaveCount(0)
  await expect(page.getByLabel('Chargers of V1')).toHaveAttribute('placeholder', 'all')
  await expect(page.getByLabel('Chargers of V1')).toHaveAccessibleDescription(/Empty if all have one/)
})

test('a cleared id stays in the file, and missing members are reported plainly', async ({
  page,
  program,
}) => {
  await openNetwork(page, program.console, /paper(?!-)/)
  const id = page.getByLabel('Id of V1', { exact: true })
  await id.fill('')
  await expect(id).toHaveAccessibleDescription('This must not be empty. The file keeps “V1” until then.')
  await expectAccessible(page)
  await page.keyboard.press('Tab')
  await expect(id).toHaveValue('V1')
  await expect(page.getByRole('alert')).toHaveCount(0)
  await expect(page.getByText(/^No errors:/)).toBeVisible()
  await id.fill('V11')
  await page.keyboard.press('Enter')
  await expect(page.getByText(/^No errors:/)).toBeVisible()
  await expect(page.getByLabel('Id of V11', { exact: true })).toHaveValue('V11')
})

test('vertiports are added, moved and removed by keyboard, and all of it is undone', async ({
  page,
  program,
}) => {
  await openNetwork(page, program.console, /new-york(?!-)/)
  const before = await text(page).inputValue()
  await page.getByRole('button', { name: 'Add a vertiport' }).press('Enter')
  const pin = page.getByRole('button', { name: /^V1, 4 stands/ })
  await expect(pin).toBeFocused()
  const place = await pin.getAttribute('aria-label')
  await page.keyboard.press('Shift+ArrowRight')
  await page.keyboard.press('ArrowUp')
  await expect(pin).not.toHaveAttribute('aria-label', place ?? '')
  await expect(text(page)).toHaveValue(/weights = \[3, 3, 2, 4, 3, 3, 1, 1, 1, 1\]/)
  await page.keyboard.press('Delete')
  await expect(pin).toHaveCount(0)
  for (let step = 0; step < 3; step++) await page.keyboard.press('Control+z')
  await expect(text(page)).toHaveValue(before)
  await page.keyboard.press('Control+y')
  await expect(pin).toBeVisible()
})

test('a vertiport is dragged, and nothing else in the file changes', async ({ page, program }) => {
  await openNetwork(page, program.console, /new-york(?!-)/)
  const before = (await text(page).inputValue()).split('\n')
  const pin = page.getByRole('button', { name: /^LGA/ })
  const box = await pin.boundingBox()
  const [x, y] = [(box?.x ?? 0) + 12, (box?.y ?? 0) + (box?.height ?? 0) / 2]
  await page.mouse.move(x, y)
  await page.mouse.down()
  await page.mouse.move(x + 40, y - 30, { steps: 5 })
  await page.mouse.up()
  const after = (await text(page).inputValue()).split('\n')
  const changed = after.filter((line, index) => line !== before[index])
  expect(after).toHaveLength(before.length)
  expect(changed.map((line) => line.split(' = ')[0])).toEqual(['latitude', 'longitude'])
})

test('typed text appears in the forms, but invalid TOML does not', async ({ page, program }) => {
  await openNetwork(page, program.console, /new-york(?!-)/)
  const toml = await text(page).inputValue()
  await text(page).fill(toml.replace('name = "new-york"', 'name = "new-york'))
  await expect(
    page.getByText('The text cannot be parsed, so the forms show its last valid version.'),
  ).toBeVisible()
  await expect(page.getByLabel('Stands of JFK')).toBeDisabled()
  await text(page).fill(toml.replace('stands = 8', 'stands = 12'))
  await expect(page.getByLabel('Stands of JFK')).toHaveValue('12')
  await expect(page.getByText(/^No errors:/)).toBeVisible()
  await page.reload()
  await expect(page.getByLabel('Stands of JFK')).toHaveValue('12')
})

test('a pair and a period are changed', async ({ page, program }) => {
  await openNetwork(page, program.console, /new-york(?!-)/)
  await page.getByRole('tab', { name: 'Demand' }).click()
  await page.getByRole('spinbutton', { name: /From 06:00/ }).fill('6.4')
  await page.keyboard.press('Tab')
  await expect(text(page)).toHaveValue(/shares_percent = \[6.4, 7.7/)
  await page.getByRole('button', { name: 'Edit single pairs' }).click()
  const grid = page.getByRole('grid', { name: 'Passengers a day by pair' })
  await grid.getByRole('gridcell').nth(1).focus()
  await page.keyboard.press('ArrowDown')
  await page.keyboard.press('ArrowRight')
  await page.keyboard.type('55')
  await page.keyboard.press('Enter')
  const toml = await text(page).inputValue()
  const rows = /passengers = \[\n([\s\S]*?)\n\]/.exec(toml)?.[1]?.split('\n') ?? []
  expect(rows).toHaveLength(9)
  expect(rows[1]).toMatch(/^ {4}\[\d+\.\d+, 0, 55,/)
  await expect(page.getByText(/^No errors:/)).toBeVisible()
})

test('aircraft start with a charge from a range', async ({ page, program }) => {
  await openNetwork(page, program.console, 'paper-quick')
  await page.getByRole('tab', { name: 'Fleet' }).click()
  const before = await text(page).inputValue()
  const choice = page.getByLabel('Charge at the start of the day')
  await expect(choice).toHaveValue('full')
  await choice.selectOption('drawn')
  await expect(text(page)).toHaveValue(/^start_charge = \[0\.5, 1\]$/m)
  await page.getByLabel('Lowest charge').fill('0.9')
  const highest = page.getByLabel('Highest charge')
  await highest.fill('0.6')
  await expect(page.getByText('1 error')).toBeVisible()
  await expect(highest).toHaveAccessibleDescription(
    'start_charge[1] must be at least start_charge[0], 0.9, found 0.6',
  )
  await expect(choice).toHaveAccessibleDescription(/^From a range/)
  await expectAccessible(page)
  await page.getByRole('tab', { name: 'Tariffs' }).click()
  await page.getByRole('button', { name: /^Show/ }).click()
  await expect(highest).toBeFocused()
  await page.getByLabel('Lowest charge').fill('0.3')
  await expect(page.getByText(/^No errors:/)).toBeVisible()
  await expect(text(page)).toHaveValue(/^start_charge = \[0\.3, 0\.6\]$/m)
  await choice.selectOption('full')
  await expect(text(page)).toHaveValue(before)
  await expect(highest).toHaveCount(0)
  await expect(page.getByText(/^No errors:/)).toBeVisible()
})

test('a shipped network is saved under another name', async ({ page, program }) => {
  await openNetwork(page, program.console, /paper(?!-)/)
  await page.getByLabel('Stands of V1').fill('7')
  await expect(page.getByText(/^No errors:/)).toBeVisible()
  await page.keyboard.press('Control+s')
  const name = page.getByRole('textbox', { name: 'Name' })
  await expect(name).toHaveValue('my-paper')
  await name.fill('ours')
  await page.getByRole('dialog').getByRole('button', { name: 'Save' }).click()
  await expect(page.getByText('ours is saved.')).toBeVisible()
  expect((await read(program.url, 'ours')).vertiports[0]?.stands).toBe(7)
  expect((await read(program.url, 'paper')).vertiports[0]?.stands).toBe(6)
  await page.getByLabel('Stands of V1').fill('8')
  await page.getByRole('button', { name: 'Another network' }).click()
  await page.getByRole('dialog').getByRole('button', { name: /^ours/ }).click()
  await page.getByRole('button', { name: 'Discard and open' }).click()
  await expect(page.getByLabel('Stands of V1')).toHaveValue('7')
})

test('the service checks once for all text typed without a pause', async ({ page, program }) => {
  await page.clock.install()
  await openNetwork(page, program.console, /paper(?!-)/)
  const asked: string[] = []
  page.on('request', (request) => asked.push(new URL(request.url()).pathname))
  await page.clock.pauseAt(new Date(Date.now() + 60_000))
  await text(page).focus()
  await page.keyboard.type('# a remark', { delay: 5 })
  expect(asked).toEqual([])
  const answer = page.waitForResponse(/validate/)
  await page.clock.runFor(1000)
  await answer
  expect(asked).toEqual(['/v1/networks/validate'])
})

/** Opens the small network from a file. */
async function openFile(page: Page, console: string): Promise<void> {
  await page.goto(`${console}/#/networks`)
  const file = { name: 'small.toml', mimeType: 'application/toml', buffer: Buffer.from(smallNetwork) }
  await page.getByLabel('Open a file').setInputFiles(file)
  await expect(page.getByText(/^No errors:/)).toBeVisible()
}

test('a file is opened and saved, and the deletion of a network can be undone', async ({ page, program }) => {
  await openFile(page, program.console)
  await page.getByRole('button', { name: 'Save', exact: true }).click()
  await expect(page.getByText('small is saved.')).toBeVisible()
  expect((await read(program.url, 'small')).toml).toBe(smallNetwork)

  await page.getByRole('button', { name: 'Delete' }).click()
  await expect(page.getByText('small is deleted. Its text is still here.')).toBeVisible()
  expect((await fetch(`${program.url}/v1/networks/small`)).status).toBe(404)
  await page.getByRole('status').getByRole('button', { name: 'Undo' }).click()
  await expect.poll(async () => (await fetch(`${program.url}/v1/networks/small`)).status).toBe(200)
})

test('no network is replaced without confirmation', async ({ page, program }) => {
  await fetch(`${program.url}/v1/networks/small`, {
    method: 'PUT',
    body: JSON.stringify({ toml: smallNetwork }),
  })
  await openFile(page, program.console)
  await page.getByLabel('Stands of South').fill('5')
  await page.getByRole('button', { name: 'Save', exact: true }).click()
  const dialog = page.getByRole('dialog')
  await expect(dialog.getByText('A network small already exists.')).toBeVisible()
  await expect(dialog.getByRole('button', { name: 'Replace it' })).toBeVisible()
  await dialog.getByRole('textbox', { name: 'Name' }).fill('smaller')
  await dialog.getByRole('button', { name: 'Save' }).click()
  await expect(page.getByText('smaller is saved.')).toBeVisible()
  expect((await read(program.url, 'small')).vertiports[2]?.stands).toBe(2)
  expect((await read(program.url, 'smaller')).vertiports[2]?.stands).toBe(5)
})

test('a user who may only read can edit and download, and neither saves nor plays', async ({
  page,
  program,
}) => {
  const token = program.token('read')
  await page.addInitScript((token) => sessionStorage.setItem('vertifleet-token', token), token)
  await openNetwork(page, program.console, /paper(?!-)/)
  await page.getByLabel('Stands of V1').fill('7')
  await expect(page.getByText(/^No errors:/)).toBeVisible()
  await expect(page.getByRole('button', { name: 'Save', exact: true })).toBeDisabled()
  await page.getByRole('button', { name: 'What would a day earn?' }).click()
  await expect(page.getByRole('button', { name: 'Play', exact: true })).toBeDisabled()
  const download = page.waitForEvent('download')
  await page.getByRole('button', { name: 'Download' }).click()
  expect((await download).suggestedFilename()).toBe('paper.toml')
})

test('axe finds no serious problem in the editor', async ({ page, program }) => {
  await page.goto(`${program.console}/#/networks`)
  await expect(page.getByRole('button', { name: /new-york(?!-)/ })).toBeVisible()
  await expectAccessibleInBoth(page)
  await openNetwork(page, program.console, /new-york(?!-)/)
  for (const tab of ['Vertiports', 'Fleet', 'Tariffs', 'Demand', 'Days']) {
    await page.getByRole('tab', { name: tab }).click()
    await expectAccessibleInBoth(page)
  }
  await page.getByRole('tab', { name: 'Vertiports' }).click()
  await page.getByLabel('Stands of JFK').fill('0')
  await expect(page.getByText('V104')).toBeVisible()
  await page.getByRole('button', { name: 'What would a day earn?' }).click()
  await expectAccessibleInBoth(page)
})

for (const screen of ['desk', 'phone'] as const) {
  test(`the editor looks like its screenshot (${screen})`, async ({ page, program }) => {
    await page.setViewportSize(screens[screen])
    await openNetwork(page, program.console, /new-york(?!-)/)
    await page.waitForLoadState('networkidle')
    for (const [name, tab] of [
      ['editor', 'Vertiports'],
      ['editor-demand', 'Demand'],
    ] as const) {
      await page.getByRole('tab', { name: tab }).click()
      await expectToLook(page, `${name}-${screen}`)
    }
  })
}
