// Dollars as a person reads them: whole in sums, with cents where one flight is looked at, and always with their sign where
// they are a difference.

const whole = new Intl.NumberFormat('en-US', { maximumFractionDigits: 0 })
const cents = new Intl.NumberFormat('en-US', { minimumFractionDigits: 2, maximumFractionDigits: 2 })
const oneDigit = new Intl.NumberFormat('en-US', { minimumFractionDigits: 1, maximumFractionDigits: 1 })

/** The minus of typography, which is as wide as a digit. */
const MINUS = '−'
/** Keeps a sign on the line of its dollars, which a break after it would turn into their opposite. */
const JOINER = '\u2060'
/** The dollars of an amount, with what joins them to their sign. */
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

/** Whether a difference is written as none. */
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

/** `−1.4` or `±0.0`: how many percent of the whole two shares differ by. */
export function pointDifference(share: number): string {
  return Math.abs(share) < 0.0005 ? '±0.0' : signed(100 * share, oneDigit, '+').replace(CURRENCY, '')
}

function signed(amount: number, format: Intl.NumberFormat, plus: string): string {
  const text = format.format(Math.abs(amount))
  const isZero = !/[1-9]/.test(text)
  const sign = isZero ? '' : amount < 0 ? MINUS : plus
  return sign === '' ? `$${text}` : `${sign}${JOINER}$${text}`
}
