// The map where there is WebGL: both painters draw the same, and the one is taken that is faster on the machine.

import { expect, test, withWebGL } from './support/pictures'

test.use({ launchOptions: withWebGL })

test.beforeAll(({ days }) => {
  days.make('new-york', 'new-york')
  days.make('disrupted', 'disrupted')
})

test('looks the same from both painters', async ({ page, show }) => {
  await show('picture=map&day=disrupted&at=10:31:00&painter=canvas')
  await expect(page).toHaveScreenshot('map-of-both-painters.png', { maxDiffPixelRatio: 0.02 })
  await show('picture=map&day=disrupted&at=10:31:00&painter=gpu')
  await expect(page.locator('.deck canvas')).toBeVisible()
  await expect(page).toHaveScreenshot('map-of-both-painters.png', { maxDiffPixelRatio: 0.03 })
})

test('looks the same where there is no WebGL at all', async ({ page, show }) => {
  await page.addInitScript(() => {
    const getContext = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, 'getContext')?.value as (
      this: HTMLCanvasElement,
      ...args: unknown[]
    ) => unknown
    HTMLCanvasElement.prototype.getContext = function (
      this: HTMLCanvasElement,
      kind: string,
      ...more: unknown[]
    ) {
      return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...more)
    } as HTMLCanvasElement['getContext']
  })
  await show('picture=map&day=disrupted&at=10:31:00')
  await expect(page.locator('.deck')).toHaveCount(0)
  await expect(page).toHaveScreenshot('map-of-both-painters.png', { maxDiffPixelRatio: 0.02 })
})

test('is not drawn with WebGL where that only pretends to have a graphics processor', async ({
  page,
  show,
}) => {
  await show('picture=map&day=disrupted&at=10:31:00')
  await page.waitForTimeout(1000)
  await expect(page.locator('.deck')).toHaveCount(0)
})

test('is drawn on the graphics processor where there is one', async ({ page, show }) => {
  await page.addInitScript(() => {
    const UNMASKED_RENDERER = 0x9246
    const { prototype } = WebGL2RenderingContext
    const former = Object.getOwnPropertyDescriptor(prototype, 'getParameter') as {
      value: (name: number) => unknown
    }
    const value = function (this: WebGL2RenderingContext, name: number): unknown {
      return name === UNMASKED_RENDERER ? 'A graphics processor' : former.value.call(this, name)
    }
    Object.defineProperty(prototype, 'getParameter', { value })
  })
  await show('picture=map&day=disrupted&at=10:31:00')
  await expect(page.locator('.deck canvas')).toBeVisible()
})

test('shows a base map of the operator in place of the bundled one', async ({ page, show }) => {
  const style = {
    version: 8,
    sources: {
      shape: {
        type: 'geojson',
        attribution: '<a href="#">A survey</a>',
        data: { type: 'Point', coordinates: [-74, 40.7] },
      },
    },
    layers: [{ id: 'ground', type: 'background', paint: { 'background-color': '#cfe8d5' } }],
  }
  await page.route(
    ({ pathname }) => pathname === '/style.json',
    (route) => route.fulfill({ json: style }),
  )
  await show('picture=map&day=new-york&at=10:31:00&basemap=/style.json')
  await expect(page.locator('.basemap canvas')).toBeVisible()
  await expect(page.getByText('A survey')).toBeVisible()
})
