#!/bin/bash
# A study in 8 shards on a SLURM cluster, then merged. From the folder of the scenario:
#   sbatch examples/cluster/slurm_array.sh cell.yaml results/cell_sweep
# A shard that was killed or ran out of time goes on when the same command is given again.
#SBATCH --job-name=opsim
#SBATCH --array=1-8
#SBATCH --cpus-per-task=2
#SBATCH --mem-per-cpu=2G
#SBATCH --time=02:00:00
#SBATCH --output=opsim_%A_%a.log
set -euo pipefail

scenario=${1:-cell.yaml}
folder=${2:-results/cell_sweep}

srun opsim sweep "$scenario" -o "$folder" --shard "$SLURM_ARRAY_TASK_ID/8" --processes "$SLURM_CPUS_PER_TASK"

# When all 8 are done, once, by hand or with  sbatch --dependency=afterok:<number of the array> --wrap "opsim merge <folder>":
#   opsim merge "$folder"
