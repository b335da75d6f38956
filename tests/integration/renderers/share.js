// SPDX-License-Identifier: GPL-3.0-or-later
// The share of the pixels of a WebGL context that are not background (#203040); for the pages of
// this folder.
function shareOfCity(gl) {
  const width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
  const pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let count = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    const distance = Math.abs(pixels[i] - 0x20) + Math.abs(pixels[i + 1] - 0x30) +
        Math.abs(pixels[i + 2] - 0x40);
    if (distance > 6) ++count;
  }
  return count / (width * height);
}
