#!/bin/bash
#SBATCH --job-name=sweep
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --mem-per-cpu=500M
#SBATCH --requeue
#SBATCH --open-mode=append
# Everything after the script's name is what is swept.
exec grainfall sweep "$@" --case "$SLURM_ARRAY_TASK_ID" --quiet
