// SPDX-License-Identifier: GPL-3.0-or-later
// Places on the Earth (WGS 84).

const kEquator = 6378137;  // metres
const kFlattening = 1 / 298.257223563;

/// The earth-centred position (EPSG:4978) of a longitude and latitude in degrees, and a height in
/// metres above the ellipsoid.
export function earthCentred([longitude, latitude, height = 0]) {
  const l = longitude * Math.PI / 180, b = latitude * Math.PI / 180;
  const squared = kFlattening * (2 - kFlattening);
  const radius = kEquator / Math.sqrt(1 - squared * Math.sin(b) ** 2);
  return [
    (radius + height) * Math.cos(b) * Math.cos(l), (radius + height) * Math.cos(b) * Math.sin(l),
    (radius * (1 - squared) + height) * Math.sin(b)
  ];
}
