// A canvas at the resolution of the screen: its pixels are device pixels, while drawing uses CSS
// pixels.

/** CSS pixels. */
export interface Size {
  readonly width: number
  readonly height: number
}

/** Higher resolutions would be slower without a visible difference. */
const MOST_RATIO = 2

export class Sheet {
  readonly canvas = document.createElement('canvas')
  readonly #context: CanvasRenderingContext2D

  constructor() {
    const context = this.canvas.getContext('2d')
    if (context === null) throw new Error('every browser draws on a canvas')
    this.#context = context
  }

  /** Clears the canvas, sets its size and returns the context to draw on. */
  begin({ width, height }: Size): CanvasRenderingContext2D {
    const ratio = Math.min(MOST_RATIO, devicePixelRatio)
    const [wide, tall] = [Math.round(width * ratio), Math.round(height * ratio)]
    if (this.canvas.width !== wide || this.canvas.height !== tall) {
      this.canvas.width = wide
      this.canvas.height = tall
      this.canvas.style.width = `${width}px`
      this.canvas.style.height = `${height}px`
    }
    this.#context.setTransform(ratio, 0, 0, ratio, 0, 0)
    this.#context.clearRect(0, 0, width, height)
    return this.#context
  }
}
