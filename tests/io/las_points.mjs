// Reads a LAS file with the package copc, which knows nothing of thermovox, and compares every point with the
// CSV of the same export.
//   node las_points.mjs FILE.las FILE.csv        run in the folder that holds node_modules
import { readFileSync } from 'node:fs'
import { createRequire } from 'node:module'

const { Las } = createRequire(`${process.cwd()}/`)('copc')
const [lasFile, csvFile] = process.argv.slice(2)
const las = readFileSync(lasFile)
const get = async (begin, end) => las.subarray(begin, end)

const header = Las.Header.parse(las)
const records = await Las.Vlr.walk(get, header)
const fields = Las.Vlr.find(records, 'LASF_Spec', 4)
const system = Las.Vlr.find(records, 'LASF_Projection', 2112)
const extra = Las.ExtraBytes.parse(await Las.Vlr.fetch(get, fields))
const wkt = (await Las.Vlr.fetch(get, system)).toString('latin1')
const view = Las.View.create(las.subarray(header.pointDataOffset), header, extra)

const expect = (holds, what) => {
  if (!holds) {
    console.error(`${lasFile}: ${what}`)
    process.exit(1)
  }
}
const near = (a, b, tolerance) => (Number.isNaN(a) && Number.isNaN(b)) || Math.abs(a - b) <= tolerance

const [names, ...rows] = readFileSync(csvFile, 'latin1').trim().split('\n').map((line) => line.split(','))
expect(wkt.startsWith('LOCAL_CS['), `the coordinate system is ${wkt}`)
expect(header.pointCount === rows.length && view.pointCount === rows.length,
  `${view.pointCount} points, expected ${rows.length}`)
// x y z to the rounding of 0.1 mm (and of floats, which the CSV holds), the CSV's time to a microsecond.
const columns = [['x', 'X', 6e-5], ['y', 'Y', 6e-5], ['z', 'Z', 6e-5], ['temperature', 'temperature', 0],
  ['temperature_sigma', 'temperature_sigma', 0], ['count', 'count', 0], ['time', 'time', 1e-6]]
let seen = 0
for (const [column, dimension, tolerance] of columns) {
  const read = view.getter(dimension)
  const place = names.indexOf(column)
  rows.forEach((row, i) => {
    const single = tolerance === 0 && column !== 'count'
    const written = single ? Math.fround(Number(row[place])) : Number(row[place] === 'nan' ? NaN : row[place])
    expect(near(read(i), written, tolerance), `point ${i}: ${dimension} is ${read(i)}, expected ${written}`)
    if (column === 'temperature' && !Number.isNaN(written)) seen += 1
  })
}
const colours = ['Red', 'Green', 'Blue'].map((name) => view.getter(name))
const packed = names.indexOf('rgb')
rows.forEach((row, i) => {
  const rgb = colours.reduce((sum, read) => sum * 256 + read(i) / 257, 0)
  expect(rgb === Number(row[packed]), `point ${i}: its colour is ${rgb}, expected ${row[packed]}`)
})
const ends = ['X', 'Y', 'Z'].map((name) => {
  const read = view.getter(name)
  return rows.reduce(([low, high], _, i) => [Math.min(low, read(i)), Math.max(high, read(i))], [Infinity, -Infinity])
})
ends.forEach(([low, high], axis) => expect(
  near(low, header.min[axis], 1e-9) && near(high, header.max[axis], 1e-9), `the bounds of axis ${axis} are wrong`))
expect(seen > 0 && seen < rows.length, `${seen} of ${rows.length} points have a temperature, expected some`)
console.log(`${rows.length} points, ${seen} with a temperature, as in the CSV`)
