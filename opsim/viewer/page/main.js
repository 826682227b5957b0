// The one script of our moving pages: the film of `opsim motion show`, or the replay of `opsim view`.
import { cards } from "./cards.js";
import { open } from "./open.js";

if (document.getElementById("film")) cards();
else open();
