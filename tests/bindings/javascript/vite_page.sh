#!/usr/bin/env bash
# The example page as a project of its own: npm installs the package, TypeScript checks a program against its types, Vite
# bundles the page, and Chromium shows what Vite made.
#
#   vite_page.sh PACKAGE TOOLS CHROMIUM
#
# TOOLS is a folder for Vite and TypeScript. npm fetches them where they are missing; without a network the test is skipped.
set -euo pipefail

here=$(cd -- "$(dirname -- "$0")" && pwd)
package=$(cd -- "$1" && pwd) chromium=$3
mkdir -p "$2"
tools=$(cd -- "$2" && pwd)
if [[ ! -e $tools/node_modules/vite || ! -e $tools/node_modules/typescript ]]; then
  echo '{"private": true}' >"$tools/package.json"
  if ! (cd "$tools" && timeout 100 npm install --silent --no-audit --no-fund vite typescript); then
    echo "skipped: Vite is neither in $tools nor to be had by npm"
    exit 77
  fi
fi

work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
cp "$here"/../../../bindings/javascript/examples/page/* "$here/types_test.ts" "$work/"
cd "$work"
tarball=$(npm pack --silent "$package")
echo '{"private": true, "type": "module"}' >package.json
npm install --silent --offline --no-audit --no-fund "./$tarball"
node "$tools/node_modules/typescript/bin/tsc" --noEmit --strict --target es2022 --module nodenext --lib es2022,dom types_test.ts
echo "TypeScript finds no fault in types_test.ts"
node "$tools/node_modules/vite/bin/vite.js" build --logLevel warn
node "$here/chromium_test.mjs" "$package" "$chromium" "$work/dist"
