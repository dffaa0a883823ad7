// The replay: of a report from disk, and of chosen files.

import { readFileSync } from 'node:fs'
import { pathToFileURL } from 'node:url'
import { expect, expectAccessibleInBoth, fixture, replayOfFixtures, test } from './support/pictures'
import { expectToLook, screens } from './support/screens'

let address = ''
test.beforeAll(({ days }) => {
  address = replayOfFixtures(days)
})

test('a day is played to its end', async ({ page }) => {
  await page.goto(`${address}#policy=prices&with=`)
  const scrubber = page.getByRole('slider', { name: 'Time of the day' })
  await expect(scrubber).toHaveAttribute('aria-valuetext', /^07:00:00/)
  await page.getByLabel('Speed, seconds').last().selectOption('3,600 ×')
  await page.keyboard.press('Escape')
  await page.getByRole('button', { name: 'Play', exact: true }).click()
  await expect(page.getByRole('button', { name: 'Pause' })).toBeVisible()
  await expect(scrubber).toHaveAttribute('aria-valuetext', '09:06:01, $2,860', { timeout: 20_000 })
  await expect(page.getByRole('button', { name: 'Play', exact: true })).toBeVisible()
})

test('the scrubber moves the time, by key and by pointer', async ({ page }) => {
  await page.goto(`${address}#policy=prices&with=`)
  const scrubber = page.getByRole('slider', { name: 'Time of the day' })
  await scrubber.focus()
  await page.keyboard.press('ArrowRight')
  await expect(scrubber).toHaveAttribute('aria-valuetext', /^07:01:00/)
  await page.keyboard.press('PageUp')
  await expect(scrubber).toHaveAttribute('aria-valuetext', /^07:16:00/)
  await page.keyboard.press('End')
  await expect(scrubber).toHaveAttribute('aria-valuetext', /^09:06:01/)
  const box = await scrubber.boundingBox()
  if (box === null) throw new Error('the scrubber is in the page')
  await page.mouse.move(box.x + box.width * 0.9, box.y + 20)
  await page.mouse.down()
  await page.mouse.move(box.x + box.width / 2, box.y + 20, { steps: 5 })
  await page.mouse.up()
  await expect(scrubber).toHaveAttribute('aria-valuetext', /^08:0[23]/)
})

test('steps move between decisions', async ({ page }) => {
  await page.goto(`${address}#policy=prices&with=`)
  const clock = page.getByRole('time')
  await page.getByRole('button', { name: 'Next decision' }).click()
  await expect(clock).toHaveText('07:19:21')
  await page.keyboard.press('Tab')
  await page.locator('h1').click({ force: true })
  await page.keyboard.press('ArrowRight')
  await expect(clock).toHaveText('07:19:37')
  await page.keyboard.press('ArrowLeft')
  await expect(clock).toHaveText('07:19:21')
})

test('the best play is shown first, next to the second best', async ({ page }) => {
  await page.goto(address)
  await expect(page.getByLabel('Policy', { exact: true })).toHaveValue('greedy')
  await expect(page.getByLabel('Compare with')).toHaveValue('prices')
  await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(2)
})

test('a link to a single policy shows it alone', async ({ page }) => {
  await page.goto(address)
  await page.getByLabel('Compare with').selectOption('')
  await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(1)
  await expect(page).toHaveURL(/with=(&|$)/)
  await page.reload()
  await expect(page.getByLabel('Compare with')).toHaveValue('')
  await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(1)
})

test('an immediate reload keeps the time', async ({ page }) => {
  await page.goto(`${address}#policy=prices&with=`)
  const scrubber = page.getByRole('slider', { name: 'Time of the day' })
  await scrubber.focus()
  await page.keyboard.press('End')
  await page.reload()
  await expect(scrubber).toHaveAttribute('aria-valuetext', /^09:06:01/)
})

test('a link opens the same time', async ({ page }) => {
  await page.goto(`${address}#policy=greedy&with=prices&at=08:11:30`)
  await expect(page.getByRole('time')).toHaveText('08:11:30')
  await expect(page.getByLabel('Policy', { exact: true })).toHaveValue('greedy')
  await page.getByRole('button', { name: 'Next decision' }).click()
  await expect(page).toHaveURL(/at=08:11:55/)
  await expect(page).toHaveURL(/with=prices/)
})

test('two policies are compared, with their first difference and its effect on profit', async ({ page }) => {
  await page.goto(`${address}#policy=prices&with=`)
  await page.getByLabel('Compare with').selectOption('greedy')
  await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(2)
  const difference = page.getByRole('region', { name: 'Where they first differ' })
  await expect(difference).toContainText(
    /A0\d: prices: .*; greedy: .*\.\s+With this decision alone .*; by the end of the day, with all later decisions, greedy has earned \$282 more\./,
  )
  await difference.getByRole('button').click()
  const time = /First difference at (\d\d:\d\d:\d\d)/.exec((await difference.textContent()) ?? '')?.[1] ?? ''
  await expect(page.getByRole('time')).toHaveText(time)
})

test('files of a day are opened, and faulty ones are listed', async ({ page, days }) => {
  await page.goto(pathToFileURL('dist/replay.html').href)
  const files = page.getByLabel('Choose files')
  await files.setInputFiles([fixture('tiny-1-greedy.csv')])
  await expect(page.getByRole('alert')).toHaveText(/^The scenario file \(\.json\) is missing/)
  const wrong = readFileSync(fixture('tiny-1-greedy.csv'), 'utf8').replace('A02', 'B02')
  await files.setInputFiles([fixture('tiny-1.json')])
  await expect(page.getByRole('alert')).toHaveText(/^A trace \(\.csv\) is missing/)
  await files.setInputFiles({ name: 'wrong.csv', mimeType: 'text/csv', buffer: Buffer.from(wrong) })
  await expect(page.getByRole('alert')).toBeVisible()
  await files.setInputFiles([
    { name: 'wrong.csv', mimeType: 'text/csv', buffer: Buffer.from(wrong) },
    { name: 'day.json', mimeType: 'application/json', buffer: readFileSync(fixture('tiny-1.json')) },
  ])
  await expect(page.getByRole('alert')).toContainText(
    'wrong.csv: Line 3: the day has no aircraft “B02”. Is it the trace of another day?',
  )
  await files.setInputFiles([
    { name: 'notes.csv', mimeType: 'text/csv', buffer: Buffer.from('a,b\n1,2\n') },
    { name: 'hello.json', mimeType: 'application/json', buffer: Buffer.from('{"hello": 1}') },
    {
      name: 'greedy.csv',
      mimeType: 'text/csv',
      buffer: readFileSync(fixture('tiny-1-greedy.csv')),
    },
  ])
  await expect(page.getByRole('alert').getByRole('listitem')).toHaveText([
    /^hello\.json: It is not a scenario file/,
    /^notes\.csv: It is neither a trace nor a scenario: it begins with “a,b”/,
  ])
  await files.setInputFiles([
    fixture('tiny-1.json'),
    fixture('tiny-1-greedy.csv'),
    fixture('tiny-1-prices.csv'),
  ])
  await expect(page.getByLabel('Policy', { exact: true })).toHaveValue('greedy')
  expect(days.folder).not.toBe('')
})

test('a selection on a timeline is selected on the map', async ({ page }) => {
  await page.goto(`${address}#policy=prices&with=&at=07:05:00`)
  await page.getByRole('application', { name: /Timeline of the fleet/ }).focus()
  await page.keyboard.press('ArrowRight')
  const map = page.getByRole('region', { name: 'Map' })
  await expect(map.getByText('A01, aircraft of type “air-taxi”')).toBeVisible()
  await expect(map.getByText('South → East')).toBeVisible()
})

test('a report of the program opens from disk and requests nothing', async ({ page, days }) => {
  days.run('scenario', fixture('tiny.toml'), '--seed', '1', '-o', 'day.json')
  days.run('simulate', 'day.json', '--policy', 'greedy', '--report', 'day.html')
  days.run(
    'compare',
    '--network',
    fixture('tiny.toml'),
    '--policies',
    'greedy,prices',
    '--days',
    '2',
    '--seed',
    '1',
    '--report',
    'report',
  )
  const asked: string[] = []
  page.on('request', (request) => asked.push(request.url()))
  await page.goto(pathToFileURL(days.path('day.html')).href)
  await page.getByTitle('Replay').scrollIntoViewIfNeeded()
  const replay = page.frameLocator('iframe[title=Replay]')
  const profit = replay.getByRole('definition').nth(1)
  await expect(profit).not.toHaveText('$3,142')
  await replay.getByRole('slider', { name: 'Time of the day' }).focus()
  await page.keyboard.press('End')
  await expect(profit).toHaveText('$3,142')
  // The address of the report restores the time.
  await expect.poll(() => page.evaluate(() => location.hash)).toContain('at=')
  await page.reload()
  await expect(page.getByTitle('Replay')).toBeInViewport()
  await expect(profit).toHaveText('$3,142')
  await page.goto(pathToFileURL(days.path('report/report.html')).href)
  const frame = page.frameLocator('iframe[title=Replay]')
  await page.getByTitle('Replay').scrollIntoViewIfNeeded()
  await expect(frame.getByLabel('Day', { exact: true })).toHaveValue('tiny-1')
  await frame.getByLabel('Compare with').selectOption({ index: 1 })
  await expect(frame.getByRole('region', { name: 'Map' })).toHaveCount(2)
  await expect(frame.getByRole('button', { name: 'Link' })).toHaveCount(1)
  await page.getByRole('link', { name: 'replay.html' }).click()
  await expect(page.getByLabel('Day', { exact: true })).toHaveValue('tiny-1')
  expect(asked.filter((one) => !one.startsWith('file:') && !one.startsWith('data:'))).toEqual([])
})

test('the page contains the licence notices of its packages', async ({ page }) => {
  await page.goto(address)
  const notices = await page.locator('#licences').textContent()
  expect(notices).toMatch(/^svelte \d+\.\d+\.\d+, MIT$/m)
  expect(notices).toContain('Natural Earth')
})

for (const [name, size] of Object.entries(screens)) {
  test(`the replay looks like its screenshot, and axe finds no serious problem (${name})`, async ({
    page,
  }) => {
    await page.setViewportSize(size)
    await page.goto(`${address}#policy=prices&with=greedy&at=07:41:00`)
    await expectToLook(page, `replay-${name}`)
    await expectAccessibleInBoth(page)
  })
}
