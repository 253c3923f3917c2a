// The last states of a world.
import {close, Closed} from "./plumb.closed.mjs";
import {PlumbError, refuse, whole} from "./plumb.definitions.mjs";
import {call, calls, result} from "./plumb.memory.mjs";
import {World} from "./plumb.world.mjs";

const forgotten = new FinalizationRegistry((address) => calls.rollback_destroy(address));

/// The last states of a world in memory, for network play: a late input is taken by going back and stepping again.
const kFarStep = Number.MAX_SAFE_INTEGER;
export class Rollback extends Closed {
  get _kind() { return "Rollback"; }
  #world;  // which stays as long as this does
  _address;
  constructor(world, frames) {
    super();
    if (!(world instanceof World)) refuse("world", world, "must be a World");
    this.#world = world;
    this._address = call("rollback_create", [world._address, whole(frames, "frames", 1, 10000)]);
    forgotten.register(this, this._address, this);
  }
  /// Saves the present state under its step count, instead of the oldest one if it is full.
  save() { this.#call("rollback_save"); }
  /// Restores the state after `step` steps, and drops later ones.
  backTo(step) { this.#call("rollback_back_to", whole(step, "step", -kFarStep, kFarStep)); }
  holds(step) { return this.#call("rollback_holds", whole(step, "step", -kFarStep, kFarStep)) !== 0; }
  get oldest() { return result(this.#call("rollback_range"))[0]; }
  get latest() { return result(this.#call("rollback_range"))[1]; }
  get size() { return result(this.#call("rollback_range"))[2]; }
  destroy() {
    forgotten.unregister(this);
    if (this._address !== 0) calls.rollback_destroy(this._address);
    this._address = 0;
  }
  #call(name, ...args) {
    if (this._address === 0 || !this.#world._alive)
      throw new PlumbError("UnknownName", "the rollback or its world was destroyed", "rollback");
    return call(name, [this._address, ...args]);
  }
}

close({Rollback});
