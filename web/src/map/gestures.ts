// How a person moves the map: drag, wheel, two fingers, double click. The map is told what to do and decides what it means.

export interface Moves {
  pan: (dx: number, dy: number) => void
  /** Zooms by a factor around a pixel. */
  zoom: (factor: number, x: number, y: number) => void
  /** The pointer is over a pixel without a button, or has left. */
  point: (at: { x: number; y: number } | undefined) => void
  /** A click or tap that was no drag. */
  press: (x: number, y: number, isTouch: boolean) => void
}

/** A pointer that moves less than this between press and release has clicked. */
const CLICK_PX = 4
/** How much one notch of a wheel zooms; trackpads send many small ones. */
const WHEEL_RATE = 0.0016
const PINCH_WHEEL_RATE = 0.01

interface Finger {
  x: number
  y: number
}

/** Listens on an element until the returned function is called. */
export function listen(element: HTMLElement, moves: Moves): () => void {
  const gestures = new Gestures(element, moves)
  const stop = new AbortController()
  const on = <K extends keyof HTMLElementEventMap>(type: K, act: (event: HTMLElementEventMap[K]) => void) =>
    element.addEventListener(type, act, { signal: stop.signal, passive: false })
  on('pointerdown', (event) => gestures.down(event))
  on('pointermove', (event) => gestures.move(event))
  on('pointerup', (event) => gestures.up(event))
  on('pointercancel', (event) => gestures.cancel(event))
  on('pointerleave', () => moves.point(undefined))
  on('wheel', (event) => gestures.wheel(event))
  on('dblclick', (event) => gestures.doubleClick(event))
  return () => stop.abort()
}

class Gestures {
  readonly #fingers = new Map<number, Finger>()
  #travelled = 0

  constructor(
    private readonly element: HTMLElement,
    private readonly moves: Moves,
  ) {}

  down(event: PointerEvent): void {
    if (event.button !== 0) return
    this.element.setPointerCapture(event.pointerId)
    if (this.#fingers.size === 0) this.#travelled = 0
    this.#fingers.set(event.pointerId, this.#place(event))
  }

  move(event: PointerEvent): void {
    const place = this.#place(event)
    const former = this.#fingers.get(event.pointerId)
    if (former === undefined) {
      if (event.pointerType !== 'touch') this.moves.point(place)
      return
    }
    const other = [...this.#fingers].find(([id]) => id !== event.pointerId)?.[1]
    if (other === undefined) this.#drag(former, place)
    else this.#pinch(other, former, place)
    this.#fingers.set(event.pointerId, place)
  }

  up(event: PointerEvent): void {
    const place = this.#fingers.get(event.pointerId)
    const wasAlone = this.#fingers.size === 1
    this.cancel(event)
    if (place !== undefined && wasAlone && this.#travelled <= CLICK_PX) {
      this.moves.press(place.x, place.y, event.pointerType === 'touch')
    }
  }

  cancel(event: PointerEvent): void {
    this.#fingers.delete(event.pointerId)
  }

  wheel(event: WheelEvent): void {
    event.preventDefault()
    const { x, y } = this.#place(event)
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1
    const rate = event.ctrlKey ? PINCH_WHEEL_RATE : WHEEL_RATE
    this.moves.zoom(Math.exp(-event.deltaY * lines * rate), x, y)
  }

  doubleClick(event: MouseEvent): void {
    const { x, y } = this.#place(event)
    this.moves.zoom(event.shiftKey ? 0.5 : 2, x, y)
  }

  #drag(from: Finger, to: Finger): void {
    this.#travelled += Math.hypot(to.x - from.x, to.y - from.y)
    if (this.#travelled > CLICK_PX) this.moves.pan(to.x - from.x, to.y - from.y)
  }

  /** One finger has moved, the other has not: the picture follows the middle and the distance of both. */
  #pinch(other: Finger, from: Finger, to: Finger): void {
    this.#travelled = Infinity
    const [before, after] = [
      Math.hypot(from.x - other.x, from.y - other.y),
      Math.hypot(to.x - other.x, to.y - other.y),
    ]
    this.moves.pan((to.x - from.x) / 2, (to.y - from.y) / 2)
    if (before > 0) this.moves.zoom(after / before, (to.x + other.x) / 2, (to.y + other.y) / 2)
  }

  #place(event: MouseEvent): Finger {
    const { left, top } = this.element.getBoundingClientRect()
    return { x: event.clientX - left, y: event.clientY - top }
  }
}
