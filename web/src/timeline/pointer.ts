// How a person moves a timeline with a pointer. Scrolling up and down is the browser's; along the day it is ours.

export interface TimelineMoves {
  /** Moves the day by pixels. */
  pan: (dx: number) => void
  /** Scrolls the rows by pixels, where the browser does not. */
  scroll: (dy: number) => void
  zoom: (factor: number, x: number) => void
  point: (at: { x: number; y: number } | undefined) => void
  press: (x: number, y: number) => void
}

/** A pointer that moves less than this between press and release has clicked. */
const CLICK_PX = 4
const WHEEL_RATE = 0.01

/** Listens on an element until the returned function is called. */
export function listen(element: HTMLElement, moves: TimelineMoves): () => void {
  const pointers = new Pointers(element, moves)
  const stop = new AbortController()
  const on = <K extends keyof HTMLElementEventMap>(type: K, act: (event: HTMLElementEventMap[K]) => void) =>
    element.addEventListener(type, act, { signal: stop.signal, passive: false })
  on('pointerdown', (event) => pointers.down(event))
  on('pointermove', (event) => pointers.move(event))
  on('pointerup', (event) => pointers.up(event))
  on('pointercancel', (event) => pointers.cancel(event))
  on('pointerleave', () => moves.point(undefined))
  on('wheel', (event) => pointers.wheel(event))
  return () => stop.abort()
}

class Pointers {
  readonly #down = new Map<number, { x: number; y: number }>()
  #travelled = 0

  constructor(
    private readonly element: HTMLElement,
    private readonly moves: TimelineMoves,
  ) {}

  down(event: PointerEvent): void {
    // The scroll bar belongs to the browser.
    if (event.button !== 0 || event.offsetX > this.element.clientWidth) return
    this.element.setPointerCapture(event.pointerId)
    if (this.#down.size === 0) this.#travelled = 0
    this.#down.set(event.pointerId, this.#place(event))
  }

  move(event: PointerEvent): void {
    const place = this.#place(event)
    const former = this.#down.get(event.pointerId)
    if (former === undefined) {
      if (event.pointerType !== 'touch') this.moves.point(place)
      return
    }
    const other = [...this.#down].find(([id]) => id !== event.pointerId)?.[1]
    if (other === undefined) this.#drag(former, place, event.pointerType === 'touch')
    else this.#pinch(other.x, former.x, place.x)
    this.#down.set(event.pointerId, place)
  }

  up(event: PointerEvent): void {
    const place = this.#down.get(event.pointerId)
    const wasAlone = this.#down.size === 1
    this.cancel(event)
    if (place !== undefined && wasAlone && this.#travelled <= CLICK_PX) this.moves.press(place.x, place.y)
  }

  cancel(event: PointerEvent): void {
    this.#down.delete(event.pointerId)
  }

  /** With Ctrl, and so by pinching a trackpad, a wheel zooms; sideways or with Shift it moves the day. */
  wheel(event: WheelEvent): void {
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1
    const sideways = event.shiftKey && event.deltaX === 0 ? event.deltaY : event.deltaX
    if (event.ctrlKey || event.metaKey) {
      event.preventDefault()
      this.moves.zoom(Math.exp(-event.deltaY * lines * WHEEL_RATE), this.#place(event).x)
    } else if (Math.abs(sideways) > Math.abs(event.shiftKey ? 0 : event.deltaY)) {
      event.preventDefault()
      this.moves.pan(-sideways * lines)
    }
  }

  #drag(from: { x: number; y: number }, to: { x: number; y: number }, isTouch: boolean): void {
    this.#travelled += Math.hypot(to.x - from.x, to.y - from.y)
    if (this.#travelled <= CLICK_PX) return
    this.moves.pan(to.x - from.x)
    if (!isTouch) this.moves.scroll(from.y - to.y)
  }

  #pinch(other: number, from: number, to: number): void {
    this.#travelled = Infinity
    const [before, after] = [Math.abs(from - other), Math.abs(to - other)]
    if (before > 4 && after > 4) this.moves.zoom(after / before, (to + other) / 2)
    this.moves.pan((to - from) / 2)
  }

  #place(event: MouseEvent): { x: number; y: number } {
    const { left, top } = this.element.getBoundingClientRect()
    return { x: event.clientX - left, y: event.clientY - top }
  }
}
