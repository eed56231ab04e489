echo "name: x" > not_a.db; "$crashpulse" sql not_a.db "SELECT 1"
