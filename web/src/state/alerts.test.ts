import { expect, it } from 'vitest'
import type { Alert } from '../model/alerts'
import { Alerts } from './alerts.svelte'

const over: Alert = {
  key: 'over_full V2',
  severity: 'critical',
  matter: { kind: 'over_full', vertiport: 'V2', taken: 7, stands: 6 },
  since: undefined,
  target: undefined,
}
const full: Alert = { ...over, key: 'full V1', severity: 'notice' }

function storage(): Pick<Storage, 'getItem' | 'setItem'> {
  const kept = new Map<string, string>()
  return { getItem: (key) => kept.get(key) ?? null, setItem: (key, text) => void kept.set(key, text) }
}

it('acknowledged alerts come last, and one that comes back is new', () => {
  const list = new Alerts('day', storage())
  const keys = (alerts: Alert[], time: number) => list.listed(alerts, time).map(({ key }) => key)
  expect(keys([over, full], 100)).toEqual(['over_full V2', 'full V1'])
  list.acknowledge(['over_full V2'])
  expect(keys([over, full], 400)).toEqual(['full V1', 'over_full V2'])
  expect(list.listed([over, full], 400)[1]).toMatchObject({ since: 100, isAcknowledged: true })
  expect(keys([full], 500)).toEqual(['full V1'])
  expect(list.listed([over, full], 600)[0]).toMatchObject({
    key: 'over_full V2',
    since: 600,
    isAcknowledged: false,
  })
})

it('acknowledgements of event notices survive a reload', () => {
  const kept = storage()
  const notice: Alert = { ...over, key: 'notice 4 x', matter: { kind: 'notice', text: 'x' }, since: 50 }
  const list = new Alerts('day', kept)
  list.listed([notice], 100)
  list.acknowledge(['notice 4 x'])
  expect(new Alerts('day', kept).listed([notice], 900)[0]?.isAcknowledged).toBe(true)
  expect(new Alerts('other', kept).listed([notice], 900)[0]?.isAcknowledged).toBe(false)
  kept.setItem('vertifleet-acknowledged day', '{"a": 1}')
  expect(new Alerts('day', kept).listed([notice], 900)[0]?.isAcknowledged).toBe(false)
})
