// The texts of alerts.

import type { Matter } from '../model/alerts'
import { clockMinutes } from '../model/time'
import { text } from './text'

export function saidOfAlert(matter: Matter): string {
  const said = text.alerts.said
  const time = (until: number | undefined) => (until === undefined ? undefined : clockMinutes(until))
  switch (matter.kind) {
    case 'overdue':
      return said.overdue[matter.report](matter.aircraft, matter.to, clockMinutes(matter.due))
    case 'over_full':
      return said.over_full(matter.vertiport, matter.taken, matter.stands)
    case 'full':
      return said.full(matter.vertiport, matter.stands)
    case 'closed':
      return said.closed(matter.what, time(matter.until), matter.underWay)
    case 'out_of_service':
      return said.out_of_service(matter.aircraft, time(matter.until))
    case 'low_charge':
      return said.low_charge(matter.aircraft, matter.to, matter.percent)
    case 'said':
      return matter.words
  }
}
