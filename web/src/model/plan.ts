// The plan that a policy made in the morning: an outlook from before the first event, as a record
// to compare with the actual day.

import type { Outlook } from '../api/types'
import { legsOf } from './expectedLegs'
import { frameOf } from './live'
import type { DayRecord, Seconds } from './record'
import { Reports } from './reports'
import type { Scenario } from './scenario'

/**
 * A plan with the forecast demand and the closures known then. Its legs are all expected, because
 * none was flown. If the day is not over, the plan is cut off at the current time.
 */
export function recordOfPlan(scenario: Scenario, outlook: Outlook, until: Seconds = Infinity): DayRecord {
  const { closures, outages } = new Reports(scenario)
  const legs = legsOf(outlook, scenario).filter((leg) => leg.decided <= until)
  const demand = { passengers: scenario.forecast ?? scenario.demand }
  return { ...frameOf(scenario), legs, closures: [...closures], outages, demand }
}
