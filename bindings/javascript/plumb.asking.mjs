// Calls during which the engine asks the user's functions: hooks, filters and conditions.
import {answered} from "./plumb.definitions.mjs";
import {readContact, Shape} from "./plumb.handles.mjs";
import {answers, call, calls, view} from "./plumb.memory.mjs";

/// A call during which the engine asks the user's functions. An error of theirs must not leave by way of the engine, whose
/// stack nothing unwinds: it is kept, further questions are answered with yes, and it is thrown when the call has ended.
class Asking {
  constructor(world, condition = null) {
    this.world = world;
    this.condition = condition;
    this.thrown = null;
  }
  ask(field, question) {
    if (this.thrown !== null) return 1;
    try {
      return answered(question(), field) ? 1 : 0;
    } catch (error) {
      this.thrown = {error};
      return 1;
    }
  }
}
let asked = null;  // the call that asks now
/// Calls the engine; it asks `world` or `condition`. An error of the engine's leaves no lock behind.
export function asking(world, condition, name, args, input) {
  const before = asked, mine = new Asking(world, condition), address = world._address;
  const locks = calls.world_locks(address), stepping = calls.world_stepping(address);
  asked = mine;
  let made;
  try {
    made = call(name, args, input);
  } catch (error) {
    calls.world_set_locks(address, locks, stepping);
    throw error;
  } finally {
    asked = before;
  }
  if (mine.thrown !== null) throw mine.thrown.error;
  return made;
}

/// Does `work`, which asks the user's functions, with the world locked as in the engine's callbacks.
export function locked(world, work) {
  const address = world._address, locks = calls.world_locks(address), stepping = calls.world_stepping(address);
  calls.world_set_locks(address, locks + 1, stepping);
  try {
    return work();
  } finally {
    calls.world_set_locks(address, locks, stepping);
  }
}

/// Makes a query, whose filter may ask a condition.
export function query(name, args, input, world, filter) {
  return filter?.condition ? asking(world, filter.condition, name, args, input) : call(name, args, input);
}

answers.preSolve = () => asked.ask("onPreSolve", () => asked.world._preSolve(readContact(asked.world)));
answers.filter = () => asked.ask("onFilter", () => {
  const n = view(Float64Array, calls.numbers(4), 4);
  return asked.world._filter(new Shape(asked.world, n[0], n[1]), new Shape(asked.world, n[2], n[3]));
});
answers.condition = (index, generation) =>
  asked.ask("condition", () => asked.condition(new Shape(asked.world, index, generation)));
