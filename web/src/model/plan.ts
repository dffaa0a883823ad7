// The day as a policy planned it in the morning: an outlook that was made before anything happened, as a record to play beside
// what has become of the day.

import type { Outlook } from '../api/types'
import { frameOf, legsOf } from './live'
import type { DayRecord, Seconds } from './record'
import { Reports } from './reports'
import type { Scenario } from './scenario'

/** A plan with the demand of the forecast and the closures that were known. Its legs stay expected, since none was flown. Of a
 *  day that is not over, it is shown as far as the day has come. */
export function recordOfPlan(scenario: Scenario, outlook: Outlook, until: Seconds = Infinity): DayRecord {
  const { closures, outages } = new Reports(scenario)
  const legs = legsOf(outlook, scenario).filter((leg) => leg.decided <= until)
  const demand = { passengers: scenario.forecast ?? scenario.demand }
  return { ...frameOf(scenario), legs, closures, outages, demand }
}
