// The performances of a run, decoded when somebody begins them and kept for a while.
import { columnsOfModel } from "./columns.js";
import { FramesModel } from "./decode_frames.js";

const KEPT = 240;
const CODECS = { frames: FramesModel };

export class Performances {
  constructor(models, columns, skeletons) {
    this.columns = columns;
    this.kept = new Map();
    this.models = models.map((model) => {
      const Codec = CODECS[model.codec];
      if (!Codec) throw new Error(`this page does not know the codec ${model.codec}`);
      return new Codec(model, columnsOfModel(columns, model), skeletons[model.skeleton]);
    });
  }

  /** The decoded performance of this number; the one that was asked for longest ago makes room. */
  of(number) {
    let found = this.kept.get(number);
    if (found) this.kept.delete(number);
    else found = this.models[this.columns.perf_model[number]].performance(this.columns.perf_row[number]);
    this.kept.set(number, found);
    if (this.kept.size > KEPT) this.kept.delete(this.kept.keys().next().value);
    return found;
  }
}
