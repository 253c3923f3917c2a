// The page has the colours and the keys of the window: node like_window_test.mjs demos/window
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {join} from "node:path";
import test from "node:test";
import {kCommands} from "../../demos/web/page/player.mjs";

const [window_folder] = process.argv.slice(2);
const page_folder = new URL("../../demos/web/page/", import.meta.url);

// All groups of numbers in brackets and the widths of lines, in their order.
const numbers = (text) => [...text.matchAll(/[[{]\s*(\d+(?:, \d+){2,3})[\]}]|, (\d\.?\d*)\)/g)].map((match) => match[1] ?? match[2]);

test("colours", () => {
  const part = (text, first, last) => text.slice(text.indexOf(first), text.indexOf(last));
  const there = readFileSync(join(window_folder, "theme.cpp"), "utf8");
  const here = readFileSync(new URL("theme.mjs", page_folder), "utf8");
  const styles = numbers(part(there, "kStyles", "kGhosts"));
  assert.ok(styles.length > 40);
  assert.deepEqual(numbers(part(here, "kStyles", "kAwake")), styles);
  assert.deepEqual(numbers(part(here, "kGhosts", "const css")), numbers(part(there, "kGhosts", "}  // namespace")));
  const rest = numbers(part(there, "Theme::ground", "Theme::paint"));
  assert.equal(rest.length, 6);
  assert.deepEqual(numbers(part(here, "get ground", "get plot")), rest);
});

test("keys", () => {
  const there = readFileSync(join(window_folder, "player.cpp"), "utf8");
  const keys = [...there.matchAll(/CommandKey\{"[^"]+", Command::\w+, "([^"]+)", "([^"]+)"\}/g)].map(([, label, about]) => [label, about]);
  // These belong to the browser.
  const expected = keys.filter(([label]) => !["F12", "Esc"].includes(label));
  assert.ok(expected.length >= 9);
  assert.deepEqual(kCommands.map(([, label, about]) => [label, about]), expected);
});
