// Why the advised choice is the first, in one sentence.

import type { kindOfNumber, Lead } from '../model/decisions'
import { dollarsAndCents, tenths } from '../model/money'
import { text } from './text'

export function leadText({ of, by, part }: Lead, kind: ReturnType<typeof kindOfNumber>): string {
  const texts = text.decision.lead
  const amount = {
    worth: () => dollarsAndCents(by),
    dollars_per_hour: () => texts.perHour(dollarsAndCents(by)),
    none: () => texts.points(tenths(by)),
  }[kind]()
  return part === undefined
    ? texts.ahead(of, amount)
    : texts.because(of, amount, texts.parts[part.name], dollarsAndCents(part.by_usd))
}
