// Reads the style sheet's colours, for drawing on a canvas. A custom property is text until a
// colour property uses it, so each is read through an element that does.

const colourNames = [
  'ground',
  'surface',
  'raised',
  'sunken',
  'line',
  'line-strong',
  'hover',
  'chosen',
  'ink',
  'ink-soft',
  'accent',
  'accent-ground',
  'good',
  'warn',
  'bad',
  'flying',
  'charging',
  'waiting',
  'holding',
  'out',
  'demand',
  'sea',
  'land',
  'coast',
  'border',
  'grid',
] as const

export type ColourName = (typeof colourNames)[number]
export type Rgb = [red: number, green: number, blue: number]

/**
 * All colours as red, green and blue from 0 to 255, as computed within an element. They are read
 * again when the theme changes.
 */
export function colours(within: Element): Record<ColourName, Rgb> {
  const probe = document.createElement('span')
  probe.hidden = true
  within.append(probe)
  const read = colourNames.map((name) => {
    probe.style.color = `var(--${name})`
    return [name, rgbOf(getComputedStyle(probe).color)] as const
  })
  probe.remove()
  return Object.fromEntries(read) as Record<ColourName, Rgb>
}

/** A colour for a canvas. */
export function css([red, green, blue]: Rgb, opacity = 1): string {
  return `rgb(${red} ${green} ${blue} / ${opacity})`
}

/** Parses `rgb(1, 2, 3)`, the format in which browsers compute colours. */
function rgbOf(computed: string): Rgb {
  const [red = 0, green = 0, blue = 0] = (computed.match(/[\d.]+/g) ?? []).map(Number)
  return [red, green, blue]
}
