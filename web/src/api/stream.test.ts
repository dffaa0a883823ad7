import { describe, expect, it } from 'vitest'
import { follow, MessageReader, type Connection, type Message } from './stream'

const encoder = new TextEncoder()

function readInPieces(text: string, cuts: number[]): Message[] {
  const bytes = encoder.encode(text)
  const reader = new MessageReader()
  const ends = [...cuts, bytes.length]
  return ends.flatMap((end, at) => reader.push(bytes.subarray(at === 0 ? 0 : (ends[at - 1] ?? 0), end)))
}

describe('messages', () => {
  const text =
    ': hello\n\nid: 7\ndata: {"reason":"Nebel über der Bucht ✈"}\n\r\nevent: behind\r\ndata: a\r\ndata:b\r\n\r\nid:8\rdata: c\r\rdata: cut off'
  const messages: Message[] = [
    { type: 'message', data: '{"reason":"Nebel über der Bucht ✈"}', id: '7' },
    { type: 'behind', data: 'a\nb', id: '7' },
    { type: 'message', data: 'c', id: '8' },
  ]

  it('are read from one chunk', () => {
    expect(readInPieces(text, [])).toEqual(messages)
  })

  it('are the same wherever the bytes are split, even inside characters', () => {
    const length = encoder.encode(text).length
    for (let first = 0; first <= length; first++) {
      expect(readInPieces(text, [first]), `cut at ${first}`).toEqual(messages)
      const second = (first * 7) % (length + 1)
      expect(readInPieces(text, [Math.min(first, second), Math.max(first, second)])).toEqual(messages)
    }
  })

  it('are the same byte by byte', () => {
    const length = encoder.encode(text).length
    expect(readInPieces(text, [...Array(length).keys()])).toEqual(messages)
  })
})

/** Answers requests in order, and records the sequence numbers that they asked for. */
class FakeService {
  readonly askedAfter: string[] = []
  readonly connections: Connection[] = []
  readonly seen: number[] = []
  rewound = 0
  readonly #answers: (() => Response)[]
  #time = 0

  constructor(answers: (() => Response)[]) {
    this.#answers = answers
  }

  async followToTheEnd(after: string | undefined): Promise<void> {
    await new Promise<void>((end) => {
      const stop = follow({
        url: 'http://service/stream',
        headers: () => ({ Authorization: 'Bearer vf_1' }),
        after,
        onEvents: (events) => this.seen.push(...events.map((event) => event.seq)),
        onConnection: (connection) => {
          this.connections.push(connection)
        },
        onRewound: () => {
          this.rewound += 1
          end()
        },
        now: () => this.#time,
        pause: (ms) => {
          this.#time += ms
          return Promise.resolve()
        },
        fetch: (_url, request) => {
          this.askedAfter.push(new Headers(request?.headers).get('last-event-id') ?? '')
          const next = this.#answers.shift()
          if (next !== undefined) return Promise.resolve(next())
          stop()
          end()
          return Promise.reject(new TypeError('there is no further answer'))
        },
      })
    })
  }
}

function events(...numbers: number[]): () => Response {
  const message = (seq: number) => `id: ${seq}\ndata: ${JSON.stringify({ seq, mark: markOf(seq) })}\n\n`
  return () => new Response(numbers.map(message).join(''))
}

function markOf(seq: number): string {
  return `${seq}-0000000${seq}`
}

function refusal(status: number, code: string): () => Response {
  return () => new Response(JSON.stringify({ status, code, detail: 'no', title: '', type: '' }), { status })
}

function nothing(): Response {
  throw new TypeError('fetch failed')
}

describe('a stream', () => {
  it('resumes after the last event', async () => {
    const service = new FakeService([events(4, 5), nothing, events(6)])
    await service.followToTheEnd(markOf(3))
    expect(service.seen).toEqual([4, 5, 6])
    expect(service.askedAfter).toEqual([3, 5, 5, 6].map(markOf))
    expect(service.connections.slice(0, 5)).toEqual([
      'connecting',
      'connected',
      'healing',
      'healing',
      'connected',
    ])
  })

  it('is reported as lost after a while, and still recovers', async () => {
    const service = new FakeService([events(1), ...Array.from({ length: 8 }, () => nothing), events(2)])
    await service.followToTheEnd(undefined)
    expect(service.connections).toContain('lost')
    expect(service.connections.lastIndexOf('connected')).toBeGreaterThan(service.connections.indexOf('lost'))
    expect(service.seen).toEqual([1, 2])
  })

  it('ends when the service refuses the user', async () => {
    const service = new FakeService([refusal(401, 'V620'), events(1)])
    void service.followToTheEnd(undefined)
    await new Promise((resume) => setTimeout(resume, 20))
    expect(service.connections).toEqual(['connecting', 'lost'])
    expect(service.askedAfter).toEqual(['0'])
  })

  it('reports that the log was replaced', async () => {
    const service = new FakeService([refusal(404, 'V631')])
    await service.followToTheEnd(markOf(9))
    expect(service.rewound).toBe(1)
  })
})
