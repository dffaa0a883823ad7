// Numbers with their English nouns.

/** `1 day`, `1,200 days`. */
export function plural(number: number, one: string, more: string): string {
  return `${number.toLocaleString('en-US')} ${number === 1 ? one : more}`
}

/** `1,200` for 1199.7. */
export function whole(number: number): string {
  return Math.round(number).toLocaleString('en-US')
}
