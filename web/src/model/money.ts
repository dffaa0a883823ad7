// Formats dollars: whole for sums, with cents for single flights, and always with a sign for
// differences.

const whole = new Intl.NumberFormat('en-US', { maximumFractionDigits: 0 })
const cents = new Intl.NumberFormat('en-US', { minimumFractionDigits: 2, maximumFractionDigits: 2 })
const oneDigit = new Intl.NumberFormat('en-US', { minimumFractionDigits: 1, maximumFractionDigits: 1 })

/** The typographic minus, which is as wide as a digit. */
const MINUS = '−'
/**
 * Prevents a line break between a sign and its dollars, which would make a loss look like a gain.
 */
const JOINER = '\u2060'
/** The dollar sign of an amount, with the joiner before it. */
const CURRENCY = /\u2060?\$/

/** `$37,149` for sums of a day. */
export function dollars(amount_usd: number): string {
  return signed(amount_usd, whole, '')
}

/** `$96.02` for one flight. */
export function dollarsAndCents(amount_usd: number): string {
  return signed(amount_usd, cents, '')
}

/** `+$120`, `−$85` or `±$0` for differences. */
export function dollarDifference(amount_usd: number): string {
  return isNothing(amount_usd) ? `±${JOINER}$0` : signed(amount_usd, whole, '+')
}

/** Whether a difference is formatted as zero. */
export function isNothing(amount_usd: number): boolean {
  return Math.round(amount_usd) === 0
}

/** `12,345` passengers, flights, events. */
export function count(number: number): string {
  return signed(number, whole, '').replace(CURRENCY, '')
}

/** `841.7` for values that are not dollars. */
export function tenths(number: number): string {
  return signed(number, oneDigit, '').replace(CURRENCY, '')
}

/** `+12`, `−3` or `±0`. */
export function countDifference(number: number): string {
  return number === 0 ? '±0' : signed(number, whole, '+').replace(CURRENCY, '')
}

/** `84 %` of a share. */
export function percent(share: number, digits = 0): string {
  const factor = 10 ** digits
  return `${(Math.round(share * 100 * factor) / factor).toFixed(digits)} %`
}

/** `−1.4` or `±0.0`: the difference of two shares in percentage points. */
export function pointDifference(share: number): string {
  return Math.abs(share) < 0.0005 ? '±0.0' : signed(100 * share, oneDigit, '+').replace(CURRENCY, '')
}

function signed(amount: number, format: Intl.NumberFormat, plus: string): string {
  const text = format.format(Math.abs(amount))
  const isZero = !/[1-9]/.test(text)
  const sign = isZero ? '' : amount < 0 ? MINUS : plus
  return sign === '' ? `$${text}` : `${sign}${JOINER}$${text}`
}
