// serve --basemap: a custom base map from another server, under the program's content security
// policy.

import { createServer, type Server } from 'node:http'
import type { AddressInfo } from 'node:net'
import type { Locator, Page } from '@playwright/test'
import { Fleet } from './support/fleet'
import { withWebGL } from './support/pictures'
import { worldWithWaterWestOf } from './support/pmtiles'
import { Program } from './support/program'
import { expect, test as base } from './support/test'

/** Within the network of New York, so that its map shows both land and water. */
const SHORE = -73.8

const newYork = { network: 'new-york', seed: 1, policy: 'greedy' }

interface Fixtures {
  /** The address of the base map's files. */
  tiles: string
}

const test = base.extend<Fixtures>({
  // eslint-disable-next-line no-empty-pattern -- Playwright requires a pattern.
  tiles: async ({}, use) => {
    const server = tileServer()
    await new Promise<void>((listens) => server.listen(0, '127.0.0.1', listens))
    await use(`http://127.0.0.1:${(server.address() as AddressInfo).port}`)
    server.close()
  },
})

test.use({ launchOptions: withWebGL })

/** A typical file server: other origins may read files, whole or in ranges. */
function tileServer(): Server {
  const file = worldWithWaterWestOf(SHORE)
  const style = {
    version: 8,
    sources: {
      shape: {
        type: 'geojson',
        attribution: 'A style',
        data: { type: 'Point', coordinates: [SHORE, 40.7] },
      },
    },
    layers: [{ id: 'ground', type: 'background', paint: { 'background-color': '#204060' } }],
  }
  return createServer((request, response) => {
    response.setHeader('Access-Control-Allow-Origin', '*')
    response.setHeader('Access-Control-Allow-Headers', '*')
    if (request.method === 'OPTIONS') response.end()
    else if (request.url === '/style.json') response.end(JSON.stringify(style))
    else {
      const [, from, to] = /bytes=(\d+)-(\d+)/.exec(request.headers.range ?? '') ?? []
      response.writeHead(206).end(file.subarray(Number(from), Number(to) + 1))
    }
  })
}

/** The colour of the picture at a point, as `#rrggbb`. */
async function colourAt(page: Page, x: number, y: number): Promise<string> {
  const picture = (await page.screenshot({ clip: { x, y, width: 1, height: 1 } })).toString('base64')
  return page.evaluate(async (png) => {
    const image = new Image()
    image.src = `data:image/png;base64,${png}`
    await image.decode()
    const context = new OffscreenCanvas(1, 1).getContext('2d')
    context?.drawImage(image, 0, 0)
    const [red = 0, green = 0, blue = 0] = context?.getImageData(0, 0, 1, 1).data ?? []
    return `#${[red, green, blue].map((one) => one.toString(16).padStart(2, '0')).join('')}`
  }, picture)
}

/**
 * The colours near the lower corners of a base map. Its place is read each time, because the page
 * may still be arranged while it loads.
 */
async function coloursOf(basemap: Locator): Promise<{ west: string; east: string }> {
  const box = await basemap.boundingBox()
  if (box === null) throw new Error('the base map is in the page')
  const [page, y] = [basemap.page(), box.y + box.height - 40]
  const west = await colourAt(page, box.x + 150, y)
  return { west, east: await colourAt(page, box.x + box.width - 12, y) }
}

async function withBasemap(address: string, use: (program: Program) => Promise<void>): Promise<void> {
  const program = await Program.start('--basemap', address)
  try {
    await use(program)
  } finally {
    await program.stop()
  }
}

test('a PMTiles file is drawn in the console’s colours, on the map of a day and in the editor', async ({
  page,
  tiles,
}) => {
  await withBasemap(`${tiles}/world.pmtiles`, async ({ url }) => {
    const { day } = await Fleet.onNewDay(url, newYork)
    for (const view of [`day/${day}/now`, 'networks']) {
      await page.goto(`${url}/#/${view}`)
      if (view === 'networks') await page.getByRole('button', { name: /new-york(?!-)/ }).click()
      const basemap = page.locator('.basemap')
      await expect(basemap.locator('canvas')).toBeVisible()
      await expect(page.getByText('A survey')).toBeVisible()
      await expect.poll(() => coloursOf(basemap)).toEqual({ west: '#dde6ed', east: '#f7f8f7' })
    }
  })
})

test('a base map stays while the day goes on', async ({ page, tiles }) => {
  await withBasemap(`${tiles}/world.pmtiles`, async ({ url }) => {
    const fleet = await Fleet.onNewDay(url, newYork)
    await page.goto(`${url}/#/day/${fleet.day}/now`)
    await expect(page.getByText('A survey')).toBeVisible()
    const basemap = await page.locator('.basemap').elementHandle()
    for (const aircraft of await fleet.waiting()) await fleet.decide(aircraft)
    const sentOff = (await fleet.state()).aircraft.filter(({ phase }) => phase === 'sent_off')
    await fleet.report(...sentOff.map(({ id }) => ({ type: 'departed', aircraft: id }) as const))
    await expect(page.getByText(/^A map of/)).toContainText(`${sentOff.length} in the air`)
    expect(await basemap.evaluate((element) => element.isConnected)).toBe(true)
    await expect(page.getByText('A survey')).toBeVisible()
  })
})

test('a style is drawn unchanged', async ({ page, tiles }) => {
  await withBasemap(`${tiles}/style.json`, async ({ url }) => {
    await page.goto(`${url}/#/networks`)
    await page.getByRole('button', { name: /new-york(?!-)/ }).click()
    const map = page.getByRole('region', { name: 'Map of the vertiports' })
    await expect(map.getByText('A style')).toBeVisible()
    const ground = async () => {
      const box = await map.boundingBox()
      return colourAt(page, (box?.x ?? 0) + 20, (box?.y ?? 0) + 200)
    }
    await expect.poll(ground).toBe('#204060')
  })
})

test('an unavailable base map leaves the bundled one, with a message', async ({ page }) => {
  await withBasemap('http://127.0.0.1:9/world.pmtiles', async ({ url }) => {
    await page.goto(`${url}/#/networks`)
    await page.getByRole('button', { name: /new-york(?!-)/ }).click()
    await expect(page.getByText(/could not be loaded.*Natural Earth/)).toBeVisible()
  })
})
