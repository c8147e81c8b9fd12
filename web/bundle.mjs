// SPDX-License-Identifier: Apache-2.0
// Bundles the front end and writes it as C++ source: node bundle.mjs OUTPUT.cpp
import { build } from 'esbuild';
import { writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

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
function literal(text) {
  const lines = [];
  const bytes = Buffer.from(text, 'utf8');
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

#pragma GCC diagnostic ignored "-Woverlength-strings"  // clang warns at 64 kB, which every compiler can hold

namespace kinfer::report {
namespace {

constexpr char script[] =
${literal(script)};

constexpr char style[] =
${literal(style)};

}  // namespace

std::string_view report_script() { return {script, sizeof(script) - 1}; }
std::string_view report_style() { return {style, sizeof(style) - 1}; }

}  // namespace kinfer::report
`);
