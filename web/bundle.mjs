// SPDX-License-Identifier: Apache-2.0
// Bundles the front end and writes it as C++ source: node bundle.mjs OUTPUT.cpp
import { build } from 'esbuild';
import { writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { deflateSync } from 'node:zlib';

const here = dirname(fileURLToPath(import.meta.url));

async function bundled(entry, loader) {
  const result = await build({
    entryPoints: [join(here, 'src', entry)],
    bundle: true,
    minify: true,
    write: false,
    format: loader === 'ts' ? 'iife' : undefined,
    target: ['es2022', 'chrome110', 'firefox115', 'safari16'],
    legalComments: 'inline',
    logLevel: 'warning',
  });
  return result.outputFiles[0].text.trim();
}

/// One C++ string literal a line of at most 4000 characters; long literals are slow in some compilers and editors.
/// Compressed by zlib: two thirds of a megabyte less in the program.
function literal(text) {
  const lines = [];
  const bytes = deflateSync(Buffer.from(text, 'utf8'), { level: 9 });
  for (let i = 0; i < bytes.length; i += 4000) {
    let line = '';
    for (const byte of bytes.subarray(i, i + 4000)) {
      if (byte === 0x22 || byte === 0x5c) line += '\\' + String.fromCharCode(byte);
      else if (byte === 0x3f) line += '\\?'; // no trigraphs
      else if (byte < 0x20 || byte > 0x7e) line += '\\' + byte.toString(8).padStart(3, '0');
      else line += String.fromCharCode(byte);
    }
    lines.push(`    "${line}"`);
  }
  return lines.join('\n');
}

const script = await bundled('main.ts', 'ts');
const style = await bundled('style.css', 'css');
if (/<\/script|<!--/i.test(script)) throw new Error('the bundle would end its script element');

writeFileSync(process.argv[2], `#include "kinfer/report/bundle.hpp"
#include "kinfer/report/packed_text.hpp"

#pragma GCC diagnostic ignored "-Woverlength-strings"  // clang warns at 64 kB, which every compiler can hold

namespace kinfer::report {
namespace {

constexpr char script[] =
${literal(script)};

constexpr char style[] =
${literal(style)};

}  // namespace

std::string_view report_script() {
  static const std::string text = unpacked_text({script, sizeof(script) - 1}, ${Buffer.byteLength(script)});
  return text;
}
std::string_view report_style() {
  static const std::string text = unpacked_text({style, sizeof(style) - 1}, ${Buffer.byteLength(style)});
  return text;
}

}  // namespace kinfer::report
`);
