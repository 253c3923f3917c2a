// Chromium without a screen, told what to do through its pipe (the DevTools protocol): no package is needed.
import {spawn} from "node:child_process";
import {mkdtempSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";

const kFlags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--no-default-browser-check",
  "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars",
  "--remote-debugging-pipe"];

export class Chromium {
  #process;
  #profile = mkdtempSync(join(tmpdir(), "plumb-chromium-"));
  #waiting = new Map();
  #listeners = [];
  #last = 0;
  #read = "";

  constructor(executable) {
    this.#process = spawn(executable, [...kFlags, `--user-data-dir=${this.#profile}`],
      {stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"]});
    this.#process.on("exit", () => {
      for (const {reject} of this.#waiting.values()) reject(new Error("Chromium ended"));
    });
    this.#process.stdio[4].setEncoding("utf8").on("data", (text) => {
      const parts = (this.#read + text).split("\0");
      this.#read = parts.pop();
      for (const part of parts) this.#take(JSON.parse(part));
    });
  }

  #take(message) {
    const waiting = this.#waiting.get(message.id);
    if (!waiting) return this.#listeners.forEach((listener) => listener(message));
    this.#waiting.delete(message.id);
    if (message.error) waiting.reject(new Error(`${waiting.method}: ${message.error.message}`));
    else waiting.resolve(message.result);
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.#last;
    this.#process.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + "\0");
    return new Promise((resolve, reject) => this.#waiting.set(id, {resolve, reject, method}));
  }
  listen(listener) { this.#listeners.push(listener); }

  async close() {
    const ended = new Promise((resolve) => this.#process.on("exit", resolve));
    this.send("Browser.close").catch(() => {});
    const timer = setTimeout(() => this.#process.kill("SIGKILL"), 5000);
    await ended;
    clearTimeout(timer);
    rmSync(this.#profile, {recursive: true, force: true, maxRetries: 5});
  }
}

/// A tab of its own size. Points are pixels of CSS.
export class Page {
  complaints = [];  // what went wrong in it, and what it asked the network for
  #browser;
  #session;
  #target;

  static async open(browser, address, {width = 1200, height = 760, scale = 1, touch = false, dark = false} = {}) {
    const page = new Page();
    page.#browser = browser;
    page.#target = (await browser.send("Target.createTarget", {url: "about:blank"})).targetId;
    page.#session = (await browser.send("Target.attachToTarget", {targetId: page.#target, flatten: true})).sessionId;
    browser.listen(({method, params, sessionId}) => {
      if (sessionId === page.#session) page.#hear(method, params);
    });
    for (const domain of ["Page", "Runtime", "Log", "Network"]) await page.send(`${domain}.enable`);
    await page.send("Emulation.setDeviceMetricsOverride", {width, height, deviceScaleFactor: scale, mobile: touch});
    if (touch) await page.send("Emulation.setTouchEmulationEnabled", {enabled: true, maxTouchPoints: 5});
    const features = [{name: "prefers-color-scheme", value: dark ? "dark" : "light"}];
    await page.send("Emulation.setEmulatedMedia", {features});
    await page.send("Page.navigate", {url: address});
    return page;
  }

  #hear(method, params) {
    if (method === "Runtime.exceptionThrown") this.complaints.push(JSON.stringify(params.exceptionDetails));
    if (method === "Runtime.consoleAPICalled") this.complaints.push(JSON.stringify(params.args));
    if (method === "Log.entryAdded") this.complaints.push(params.entry.text);
    if (method === "Network.requestWillBeSent" && /^(http|ws)/.test(params.request.url))
      this.complaints.push(`asked for ${params.request.url}`);
  }

  send(method, params = {}) { return this.#browser.send(method, params, this.#session); }
  close() { return this.#browser.send("Target.closeTarget", {targetId: this.#target}); }

  /// What the expression is in the page, as JSON carries it.
  async ask(expression) {
    const {result, exceptionDetails} = await this.send("Runtime.evaluate",
      {expression, returnByValue: true, awaitPromise: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }
  /// Waits until the expression is true.
  async until(expression, seconds = 20) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end;) {
      const value = await this.ask(expression);
      if (value) return value;
      await new Promise((resolve) => setTimeout(resolve, 30));
    }
    throw new Error(`not true after ${seconds} s: ${expression}`);
  }
  frames(count) {
    return this.ask(`new Promise((done) => {
      let left = ${count};
      const next = () => --left < 0 ? done(true) : requestAnimationFrame(next);
      next();
    })`);
  }

  mouse(type, {x, y}, button = "left") {
    const names = {press: "mousePressed", move: "mouseMoved", release: "mouseReleased"};
    const buttons = type === "release" ? 0 : {left: 1, right: 2}[button];
    return this.send("Input.dispatchMouseEvent",
      {type: names[type], x, y, button, buttons, clickCount: type === "move" ? 0 : 1});
  }
  wheel({x, y}, by) {
    return this.send("Input.dispatchMouseEvent", {type: "mouseWheel", x, y, deltaX: 0, deltaY: by});
  }
  async click(point) {
    await this.mouse("press", point);
    await this.mouse("release", point);
  }
  /// `fingers`: where they are now.
  touch(type, fingers) {
    return this.send("Input.dispatchTouchEvent", {type, touchPoints: fingers.map(({x, y}, id) => ({x, y, id}))});
  }
  async key(key) {
    const text = key.length === 1 ? {text: key} : {};
    await this.send("Input.dispatchKeyEvent", {type: "keyDown", key, ...text});
    await this.send("Input.dispatchKeyEvent", {type: "keyUp", key});
  }
  /// The middle of an element.
  middle(selector) {
    return this.ask(`(() => {
      const element = document.querySelector(${JSON.stringify(selector)});
      element.scrollIntoView({block: "center"});
      const box = element.getBoundingClientRect();
      return {x: box.x + box.width / 2, y: box.y + box.height / 2, left: box.left, right: box.right};
    })()`);
  }
  async screenshot() {
    const {data} = await this.send("Page.captureScreenshot", {format: "png"});
    return Buffer.from(data, "base64");
  }
}
