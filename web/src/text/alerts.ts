// The texts of alerts.

import type { Matter } from '../model/alerts'
import { clockMinutes } from '../model/time'
import { sentenceOf } from './problems'
import { text } from './text'

export function alertText(matter: Matter): string {
  const messages = text.alerts.messages
  const time = (until: number | undefined) => (until === undefined ? undefined : clockMinutes(until))
  switch (matter.kind) {
    case 'overdue':
      return messages.overdue[matter.report](matter.aircraft, matter.to, clockMinutes(matter.due))
    case 'over_full':
      return messages.over_full(matter.vertiport, matter.taken, matter.stands)
    case 'full':
      return messages.full(matter.vertiport, matter.stands)
    case 'closed':
      return messages.closed(matter.what, time(matter.until), matter.underWay)
    case 'out_of_service':
      return messages.out_of_service(matter.aircraft, time(matter.until))
    case 'low_charge':
      return messages.low_charge(matter.aircraft, matter.to, matter.percent)
    case 'notice':
      return sentenceOf(matter.text)
  }
}
