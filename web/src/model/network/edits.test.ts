import { readFileSync } from 'node:fs'
import { describe, expect, it } from 'vitest'
import { addTable, append, apply, remove, set, type Splice } from './edits'
import { TomlError, TomlFile } from './toml'

const networks = new URL('../../../../networks/', import.meta.url)
const cities = ['san-francisco', 'los-angeles', 'dallas', 'paris']
const shipped = ['paper', 'disrupted', 'new-york', 'large', 'as-coded', ...cities]
const read = (name: string) => new TomlFile(readFileSync(new URL(`${name}.toml`, networks), 'utf8'))

/** The lines that a change removed and those that it added. */
function changed(file: TomlFile, splices: Splice[]): { gone: string[]; come: string[]; file: TomlFile } {
  const after = new TomlFile(apply(file.text, splices))
  const [before, now] = [file.text.split('\n'), after.text.split('\n')]
  const left = (lines: string[], others: string[]) => {
    const rest = [...others]
    return lines.filter((line) => {
      const at = rest.indexOf(line)
      if (at >= 0) rest.splice(at, 1)
      return at < 0
    })
  }
  return { gone: left(before, now), come: left(now, before), file: after }
}

describe('a change of a network file', () => {
  it('changes nothing else, including comments and their columns', () => {
    const file = read('new-york')
    const one = changed(file, set(file, ['operations', 'takeoff_s'], 90))
    expect(one.gone).toEqual([
      'takeoff_s = 300                 # assumption: boarding, taxi and climb in 5 minutes; paper has 15',
    ])
    expect(one.come).toEqual([
      'takeoff_s = 90                  # assumption: boarding, taxi and climb in 5 minutes; paper has 15',
    ])
    const share = changed(file, set(file, ['daily_demand', 'shares_percent', 3], 9.5))
    expect(share.come).toEqual([
      'shares_percent = [3.2, 7.7, 5.9, 9.5, 5.1, 5.9, 6.2, 6.0, 6.6, 7.7, 7.8, 8.6, 7.4, 5.6, 4.1, 3.1, 1.5]',
    ])
    expect(set(file, ['vertiports', 0, 'stands'], 4)).toEqual([])
  })

  it('changes a member of a table within a line', () => {
    const file = read('paper')
    expect(changed(file, set(file, ['demand', 'peak', 'mean'], 120)).come).toEqual([
      'peak = { mean = 120, sd = 10 }',
    ])
    const more = new TomlFile('peak = { mean = 1 }\nnone = {}\n')
    const splices = [...set(more, ['peak', 'sd'], 2), ...set(more, ['none', 'sd'], 3)]
    expect(apply(more.text, splices)).toBe('peak = { mean = 1, sd = 2 }\nnone = { sd = 3 }\n')
  })

  it('adds members to their table', () => {
    const file = read('new-york')
    const chargers = changed(file, set(file, ['vertiports', 1, 'chargers'], 2))
    expect(chargers.come).toEqual(['chargers = 2'])
    expect(chargers.file.find(['vertiports', 1, 'chargers'])).toBeDefined()
    const zone = new TomlFile('name = "a"\n\n[operations]\nstart = "06:00:00"\n')
    expect(apply(zone.text, set(zone, ['time_zone'], 'UTC'))).toBe(
      'name = "a"\ntime_zone = "UTC"\n\n[operations]\nstart = "06:00:00"\n',
    )
    const dotted = new TomlFile('[demand]\npeak.mean = 1\nlast = 2\n')
    expect(apply(dotted.text, set(dotted, ['demand', 'peak', 'sd'], 3))).toBe(
      '[demand]\npeak.mean = 1\npeak.sd = 3\nlast = 2\n',
    )
    const none = new TomlFile('name = "a"\n')
    expect(apply(none.text, set(none, ['disturbances', 'outages', 'probability'], 0.1))).toBe(
      'name = "a"\n\n[disturbances.outages]\nprobability = 0.1\n',
    )
  })

  it('adds a vertiport after the last one and leaves later comments in place', () => {
    const file = read('new-york')
    const splices = [
      ...append(file, ['vertiports'], {
        id: 'NEW',
        latitude: 40.8,
        longitude: -73.9,
        stands: 4,
        busy: false,
      }),
      ...append(file, ['daily_demand', 'gravity', 'weights'], 1),
      ...append(file, ['disturbances', 'takeoff_delays', 'vertiports'], { at: 'NEW', probability: 0.1 }),
    ]
    const { file: after } = changed(file, splices)
    expect(after.text).toContain(
      'id = "FRG"\nlatitude = 40.72927\nlongitude = -73.41342\nstands = 5\nbusy = false\n\n[[vertiports]]\nid = "NEW"\nlatitude = 40.8\nlongitude = -73.9\nstands = 4\nbusy = false\n\n# Archer Midnight',
    )
    expect(after.text).toContain('weights = [3, 3, 2, 4, 3, 3, 1, 1, 1, 1]\n')
    expect(after.text).toContain('most_s = 900 },\n    { at = "NEW", probability = 0.1 },\n]')
  })

  it('removes a table with its comments and nothing else', () => {
    const file = read('new-york')
    const { gone, come } = changed(file, remove(file, ['vertiports', 3]))
    expect(come).toEqual([])
    expect(gone).toContain('[[vertiports]]  # John F. Kennedy International')
    expect(gone.filter((line) => line !== '')).toHaveLength(6)
    const first = changed(file, remove(file, ['vertiports', 0]))
    expect(first.file.text).toContain(
      '# are the busy ones; only Eq. 1 would use it.\n[[vertiports]]  # West 30th',
    )
    const demand = changed(file, remove(file, ['daily_demand']))
    expect(demand.file.value).not.toHaveProperty('daily_demand')
    expect(demand.file.text).toContain('# assumption: moderate. Known a day ahead')
    expect(demand.file.text).not.toContain('# airports and the three heliports in Manhattan draw the most.')
  })

  it('removes entries of lists with their commas', () => {
    const file = new TomlFile(
      'a = [1, 2, 3]\nb = [\n    { x = 1 },  # one\n    { x = 2 },\n]\nc = [4]\nd = 5 # five\n',
    )
    const without = (...path: (string | number)[]) => apply(file.text, remove(file, path)).split('\n')
    expect(without('a', 0)[0]).toBe('a = [2, 3]')
    expect(without('a', 2)[0]).toBe('a = [1, 2]')
    expect(without('b', 0).slice(1, 4)).toEqual(['b = [', '    { x = 2 },', ']'])
    expect(without('b', 1).slice(1, 4)).toEqual(['b = [', '    { x = 1 },', ']'])
    expect(without('c', 0)[5]).toBe('c = []')
    expect(without('d')).not.toContain('d = 5 # five')
  })

  it('adds tables where they belong', () => {
    const file = new TomlFile('[daily_demand]\nnoise = 0.1\n\n# next\n[disturbances]\n')
    const made = apply(
      file.text,
      addTable(file, ['daily_demand', 'gravity'], { passengers: 9 }, ['daily_demand']),
    )
    expect(made).toBe(
      '[daily_demand]\nnoise = 0.1\n\n[daily_demand.gravity]\npassengers = 9\n\n# next\n[disturbances]\n',
    )
  })

  it('keeps the line endings of other systems', () => {
    const file = new TomlFile('a = 1\r\nb = 2\r\n')
    const splices = [...set(file, ['c'], 3), ...remove(file, ['a'])]
    expect(apply(file.text, splices)).toBe('b = 2\r\nc = 3\r\n')
  })

  it('writes every value of every shipped network unchanged', () => {
    for (const name of shipped) {
      const file = read(name)
      const value = file.value as Record<string, Record<string, number | string | boolean>[]>
      expect(Object.keys(value).length).toBeGreaterThan(5)
      const splices = ['vertiports', 'aircraft_types', 'fleet'].flatMap((list) =>
        (value[list] ?? []).flatMap((entry, at) =>
          Object.entries(entry).flatMap(([member, one]) => set(file, [list, at, member], one)),
        ),
      )
      expect(new TomlFile(apply(file.text, splices)).value).toEqual(value)
    }
  })
})

describe('a file', () => {
  it('finds the position of every member', () => {
    const file = read('new-york')
    const at = (text: string) => file.text.indexOf(text)
    expect(file.pathAt(at('40.69248'))).toEqual(['vertiports', 5, 'latitude'])
    expect(file.pathAt(at('weights = [3, 3, 2, 4') + 'weights = [3, 3, 2, '.length)).toEqual([
      'daily_demand',
      'gravity',
      'weights',
      3,
    ])
    expect(file.pathAt(at('{ at = "LGA", probability = 0.2') + 16)).toEqual([
      'disturbances',
      'takeoff_delays',
      'vertiports',
      4,
      'probability',
    ])
    expect(file.pathAt(0)).toEqual([])
    const span = file.span(['vertiports', 5, 'latitude'])
    expect(file.text.slice(span?.from, span?.to)).toBe('latitude = 40.69248')
    expect(file.line(file.span(['vertiports', 5, 'chargers'])?.from ?? 0)).toBe(
      file.line(at('[[vertiports]]  # Newark')),
    )
    expect(file.span(['nowhere'])).toBeUndefined()
  })

  it('reports the position of a syntax error', () => {
    const broken = () => new TomlFile('a = 1\nb = [1,\nc = 2\n')
    expect(broken).toThrow(TomlError)
    try {
      broken()
    } catch (cause) {
      expect((cause as TomlError).line).toBe(3)
    }
  })
})
