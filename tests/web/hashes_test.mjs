// The program for browsers, run by node, gives the bits of the native one:
//   node hashes_test.mjs demos.wasm test_web_hashes
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {readFileSync} from "node:fs";
import test from "node:test";
import {Engine} from "../../demos/web/page/engine.mjs";
import {hashes} from "./play.mjs";

const [program, native] = process.argv.slice(2);
const module = await WebAssembly.compile(readFileSync(program));

test("every demo and every scenario has the native state after 1000 steps", async () => {
  const expected = execFileSync(native, {encoding: "utf8"}).trim().split("\n");
  const found = hashes(await Engine.start(module));
  assert.ok(expected.length >= 11 * 6 + 23);
  assert.deepEqual(found, expected);
});

test("a state that was saved goes on in another engine to the same hash", async () => {
  const first = await Engine.start(module), second = await Engine.start(module);
  for (const {name} of first.list()) {
    first.open(name), second.open(name);
    for (let i = 0; i < 50; ++i) first.step();
    second.restore(first.save());
    assert.equal(second.hash(), first.hash(), name);
    for (let i = 0; i < 50; ++i) first.step(), second.step();
    assert.equal(second.hash(), first.hash(), name);
  }
});

test("what the engine throws reaches JavaScript as its sentence", async () => {
  const engine = await Engine.start(module);
  assert.throws(() => engine.open("bouncing_bal"), /name is 'bouncing_bal': is not a demo; did you mean 'bouncing_ball'/);
  const fresh = await Engine.start(module);
  fresh.open("bouncing_ball");
  assert.throws(() => fresh.set("gravity", 1000), /gravity.*must be a number from 0 to 20/);
});
