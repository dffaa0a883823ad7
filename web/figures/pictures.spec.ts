// Takes the pictures of the console in the README and the book, and a short recording.
// scripts/pictures runs it.

import { readFileSync, writeFileSync } from 'node:fs'
import type { Page } from '@playwright/test'
import { Fleet } from '../tests/support/fleet'
import { morning, standStill } from '../tests/support/morning'
import { expect, open, panel, test, waiting } from '../tests/support/test'

const images = '../docs/src/images'

test('pictures', async ({ page, program }) => {
  const fleet = await morning(program)
  await standStill(page)
  await page.emulateMedia({ colorScheme: 'light' })
  const take = async (name: string) => {
    await page.waitForTimeout(800)
    await page.screenshot({ path: `${images}/console-${name}.png` })
  }

  await open(page, program, fleet)
  await expect(page.locator('.figures')).toContainText('% expected')
  await take('now')
  await page.keyboard.press('o')
  await panel(page).getByRole('combobox', { name: 'Destination' }).selectOption('TEB')
  await panel(page).getByRole('textbox', { name: 'Reason' }).fill('its crew ends its day there')
  await panel(page).screenshot({ path: `${images}/console-override.png` })
  await page.keyboard.press('Escape')

  await page.goto('about:blank')
  const outlook = page.waitForResponse(/\/outlook/)
  await open(page, program, fleet, 'timeline')
  await outlook
  await take('timeline')

  await open(page, program, fleet, 'what-if')
  await page.getByRole('combobox', { name: 'From' }).selectOption('JFK')
  await page.getByRole('textbox', { name: /Until/ }).fill('09:00')
  await page.getByRole('button', { name: 'Add the change' }).click()
  await page.getByRole('button', { name: 'Compare', exact: true }).click()
  await expect(page.getByText(/They first differ at/)).toBeVisible({ timeout: 60_000 })
  await take('what-if')
})

const RECORDING = { begin: '07:26:00', frames: 96, frame_ms: 150 }
const MOST_BYTES = 3_000_000

test('recording', async ({ page, program }) => {
  const network = readFileSync('../networks/new-york.toml', 'utf8')
  void program.operate(network, '--seed', '3', '--policy', 'prices', '--speed', '60', '--by-hand')
  const fleet = await Fleet.onDayOfOthers(program.url)
  for (;;) {
    const [first] = await fleet.waiting()
    if ((await fleet.state()).now >= RECORDING.begin && first !== undefined) break
    if (first === undefined) await page.waitForTimeout(20)
    else await fleet.decide(first)
  }
  await page.emulateMedia({ colorScheme: 'dark' })
  await open(page, program, fleet)
  await expect(page.locator('.figures')).toContainText('% expected')
  const frames = await record(page)
  const gif = await encode(page, frames)
  console.log(`recording: ${frames.length} frames, ${(gif.length / 1e6).toFixed(1)} MB`)
  expect(gif.length).toBeLessThan(MOST_BYTES)
  writeFileSync(`${images}/console.gif`, gif)
})

/** Takes pictures while a user accepts a recommendation, about a second after it appeared. */
async function record(page: Page): Promise<Buffer[]> {
  const frames: Buffer[] = []
  let isRead = 0
  for (let frame = 0; frame < RECORDING.frames; frame++) {
    const begun = Date.now()
    frames.push(await page.screenshot())
    isRead = (await waiting(page).count()) > 0 ? isRead + 1 : 0
    if (isRead > 6) {
      await page.keyboard.press('a')
      isRead = 0
    }
    await page.waitForTimeout(Math.max(0, RECORDING.frame_ms - (Date.now() - begun)))
  }
  return frames
}

interface Encoder {
  writeFrame: (index: Uint8Array, width: number, height: number, options: object) => void
  finish: () => void
  bytes: () => Uint8Array
}
interface Gifenc {
  GIFEncoder: () => Encoder
  quantize: (pixels: Uint8ClampedArray, colours: number) => number[][]
  applyPalette: (pixels: Uint8ClampedArray, palette: number[][]) => Uint8Array
}

/**
 * Writes pictures as a GIF with one palette for all, storing only the changes of each frame. It
 * runs in the page, which can read pictures.
 */
async function encode(page: Page, frames: Buffer[]): Promise<Buffer> {
  await page.goto('about:blank')
  const source = readFileSync('node_modules/gifenc/dist/gifenc.esm.js', 'utf8')
  const pictures = frames.map((frame) => frame.toString('base64'))
  const encoded = await page.evaluate(
    async ({ source, pictures, delay }) => {
      const address = URL.createObjectURL(new Blob([source], { type: 'text/javascript' }))
      const gifenc = (await import(address)) as Gifenc
      const pixelsOf = async (picture: string) => {
        const bytes = Uint8Array.from(atob(picture), (one) => one.charCodeAt(0))
        const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }))
        const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d')
        if (context === null) throw new Error('there is no canvas')
        context.drawImage(bitmap, 0, 0)
        return context.getImageData(0, 0, bitmap.width, bitmap.height)
      }
      const samples = [0, 0.3, 0.6, 0.9].map((share) => pictures[Math.floor(share * pictures.length)] ?? '')
      const parts = (await Promise.all(samples.map(pixelsOf))).map(({ data }) => [...data])
      const palette = gifenc.quantize(Uint8ClampedArray.from(parts.flat()), 255)
      const transparentIndex = palette.length
      const encoder = gifenc.GIFEncoder()
      let former: Uint8Array | undefined
      for (const picture of pictures) {
        const { data, width, height } = await pixelsOf(picture)
        const index = gifenc.applyPalette(data, palette)
        const changed = index.map((colour, at) => (former?.[at] === colour ? transparentIndex : colour))
        encoder.writeFrame(changed, width, height, {
          ...(former === undefined
            ? { palette: [...palette, [0, 0, 0]] }
            : { transparent: true, transparentIndex }),
          delay,
          dispose: 1,
        })
        former = index
      }
      encoder.finish()
      let text = ''
      for (const byte of encoder.bytes()) text += String.fromCharCode(byte)
      return btoa(text)
    },
    { source, pictures, delay: RECORDING.frame_ms },
  )
  return Buffer.from(encoded, 'base64')
}
