// A style for tiles that come without one: water, land, roads and borders in the colours of the
// console. Layers are recognised by the names that the common schemas use (OpenMapTiles, Protomaps,
// Shortbread).

import type { LayerSpecification, StyleSpecification } from 'maplibre-gl'
import { TileType } from 'pmtiles'

type Ink = 'sea' | 'land' | 'coast' | 'border' | 'grid'

interface Header {
  tileType: TileType
  maxZoom: number
}

const SOURCE = 'tiles'

/**
 * How a layer of vector tiles is drawn, by its name. The first match applies; the order is from the
 * ground up.
 */
const looks: { names: RegExp; ink: Ink; kind: 'fill' | 'line'; width?: number }[] = [
  { names: /^(earth|land|landcover)$/, ink: 'land', kind: 'fill' },
  { names: /^(water|ocean|water_polygons)$/, ink: 'sea', kind: 'fill' },
  { names: /^(transportation|roads|streets)$/, ink: 'coast', kind: 'line', width: 0.75 },
  { names: /^(boundary|boundaries)$/, ink: 'border', kind: 'line', width: 1 },
]

export function styleOf(
  address: string,
  { tileType, maxZoom }: Header,
  metadata: unknown,
  ink: (name: Ink) => string,
): StyleSpecification {
  const isVector = tileType === TileType.Mvt
  const source = { url: `pmtiles://${address}`, maxzoom: maxZoom }
  return {
    version: 8,
    sources: {
      [SOURCE]: isVector ? { type: 'vector', ...source } : { type: 'raster', tileSize: 256, ...source },
    },
    layers: isVector
      ? vectorLayers(namesOf(metadata), ink)
      : [{ id: SOURCE, type: 'raster', source: SOURCE }],
  }
}

function vectorLayers(names: readonly string[], ink: (name: Ink) => string): LayerSpecification[] {
  const ground = names.some((name) => looks[0]?.names.test(name)) ? 'sea' : 'land'
  const background: LayerSpecification = {
    id: 'ground',
    type: 'background',
    paint: { 'background-color': ink(ground) },
  }
  const layers = looks.flatMap((look) =>
    names.filter((name) => look.names.test(name)).map((name) => layerOf(name, look, ink(look.ink))),
  )
  return [background, ...layers]
}

function layerOf(name: string, { kind, width }: (typeof looks)[number], colour: string): LayerSpecification {
  const common = { id: name, source: SOURCE, 'source-layer': name }
  if (kind === 'line')
    return { ...common, type: 'line', paint: { 'line-color': colour, 'line-width': width ?? 1 } }
  return {
    ...common,
    type: 'fill',
    filter: ['==', ['geometry-type'], 'Polygon'],
    paint: { 'fill-color': colour },
  }
}

/** The names of the vector layers as the file's metadata lists them. */
function namesOf(metadata: unknown): string[] {
  const layers = (metadata as { vector_layers?: { id: string }[] } | null)?.vector_layers ?? []
  return layers.map(({ id }) => id)
}
