// Pointer gestures on a picture: dragging with one, pinching with two, and clicking. Maps and
// timelines decide what these mean.

/** A place in a picture, pixels. */
export interface Pixel {
  x: number
  y: number
}

export interface PointerActions {
  /** The pointer is over a pixel without a button, or has left. */
  point: (at: Pixel | undefined) => void
  /** A click or tap that was no drag. */
  press: (at: Pixel, isTouch: boolean) => void
  drag: (from: Pixel, to: Pixel, isTouch: boolean) => void
  /** One finger has moved, the other has not. */
  pinch: (other: Pixel, from: Pixel, to: Pixel) => void
  /** The wheel has turned, by pixels, or by lines converted to pixels. */
  wheel: (event: WheelEvent, at: Pixel, pixels: number) => void
  doubleClick?: (event: MouseEvent, at: Pixel) => void
}

/** A pointer that moves less than this between press and release has clicked. */
const CLICK_PX = 4
const LINE_PX = 16

/** Listens on an element until the returned function is called. */
export function listen(element: HTMLElement, act: PointerActions): () => void {
  const pointers = new Pointers(element, act)
  const stop = new AbortController()
  const on = <K extends keyof HTMLElementEventMap>(type: K, act: (event: HTMLElementEventMap[K]) => void) =>
    element.addEventListener(type, act, { signal: stop.signal, passive: false })
  on('pointerdown', (event) => pointers.down(event))
  on('pointermove', (event) => pointers.move(event))
  on('pointerup', (event) => pointers.up(event))
  on('pointercancel', (event) => pointers.cancel(event))
  on('pointerleave', () => act.point(undefined))
  on('wheel', (event) => {
    const isInLines = event.deltaMode === WheelEvent.DOM_DELTA_LINE
    act.wheel(event, pointers.place(event), isInLines ? LINE_PX : 1)
  })
  on('dblclick', (event) => act.doubleClick?.(event, pointers.place(event)))
  return () => stop.abort()
}

class Pointers {
  readonly #down = new Map<number, Pixel>()
  #travelled = 0

  constructor(
    private readonly element: HTMLElement,
    private readonly act: PointerActions,
  ) {}

  down(event: PointerEvent): void {
    // The scroll bar belongs to the browser.
    if (event.button !== 0 || event.offsetX > this.element.clientWidth) return
    this.element.setPointerCapture(event.pointerId)
    if (this.#down.size === 0) this.#travelled = 0
    this.#down.set(event.pointerId, this.place(event))
  }

  move(event: PointerEvent): void {
    const place = this.place(event)
    const former = this.#down.get(event.pointerId)
    if (former === undefined) {
      if (event.pointerType !== 'touch') this.act.point(place)
      return
    }
    const other = [...this.#down].find(([id]) => id !== event.pointerId)?.[1]
    if (other === undefined) this.#drag(former, place, event.pointerType === 'touch')
    else {
      this.#travelled = Infinity
      this.act.pinch(other, former, place)
    }
    this.#down.set(event.pointerId, place)
  }

  up(event: PointerEvent): void {
    const place = this.#down.get(event.pointerId)
    const wasAlone = this.#down.size === 1
    this.cancel(event)
    if (place !== undefined && wasAlone && this.#travelled <= CLICK_PX)
      this.act.press(place, event.pointerType === 'touch')
  }

  cancel(event: PointerEvent): void {
    this.#down.delete(event.pointerId)
  }

  place(event: MouseEvent): Pixel {
    const { left, top } = this.element.getBoundingClientRect()
    return { x: event.clientX - left, y: event.clientY - top }
  }

  #drag(from: Pixel, to: Pixel, isTouch: boolean): void {
    this.#travelled += Math.hypot(to.x - from.x, to.y - from.y)
    if (this.#travelled > CLICK_PX) this.act.drag(from, to, isTouch)
  }
}
